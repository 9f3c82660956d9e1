#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "moclean/core/matrix.hpp"
#include "moclean/motion/skeleton.hpp"

namespace moclean {

/// Finds the channels of one frame after the other: what inverse_kinematics() says of a frame. One
/// object per thread.
class PoseSolver {
 public:
  explicit PoseSolver(const Skeleton& skeleton);

  /// Replaces the channels of a frame by those that bring its joints nearest to `positions`, three
  /// numbers per bone, NaN where unknown. `current` are the positions that the channels make.
  void solve(const double* positions, const double* current, double* channels);

  /// The rotation channels of a bone that turns freely, three about different axes in a row: the
  /// first one's place among the channels of a frame, and the axes.
  struct Turn {
    Index first = -1;  ///< -1 for any other bone
    std::array<int, 3> axes = {};
  };
  Turn turn_of(std::size_t bone) const { return links_[bone].turn; }

 private:
  enum class Freedom { none, about_axes, any };

  static Eigen::Matrix3d turn_about(int axis, double angle);

  // What motions of a limb cost: of d of its base and w of its orientation,
  //   d' dd d + 2 d' dw w + w' ww w + 2 d' gd + 2 w' gw.
  struct Cost {
    Eigen::Matrix3d dd = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d dw = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d ww = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gd = Eigen::Vector3d::Zero();
    Eigen::Vector3d gw = Eigen::Vector3d::Zero();
  };

  // Where a bone is: `base` where it turns, `turned` its orientation behind its rotation channels
  // and before Bone::after, `local` that by its rotation channels alone.
  struct Pose {
    Eigen::Vector3d travel, base;  // travel: by the translation channels
    Eigen::Matrix3d local, turned;
    std::array<double, 3> angles;  // of `about_axes`
  };

  struct Link {
    int parent = -1;
    Eigen::Vector3d shift;    // parent's base to this base, in the parent's orientation
    Eigen::Matrix3d between;  // parent's orientation to the frame of the channels
    Eigen::Vector3d tail;     // base to joint, in this orientation
    std::vector<Channel> channels;
    Index first_channel = 0;
    Freedom most = Freedom::none;  // what its channels allow
    bool travels = false;          // a root that translation channels move, one per axis
    Turn turn;

    // Of the frame at hand.
    Eigen::Vector3d target;
    bool is_seen = false, limb_is_seen = false, turn_is_seen = false;
    bool has_changed = false, has_changed_above = false, is_active = false;
    Freedom freedom = Freedom::none;
    Pose pose;

    // Of the step at hand.
    Cost cost;                // before the turns of the bone itself are at their best
    Cost rest;                // of a root: then
    Eigen::Matrix3d axes;     // of turns `about_axes` in the world, in columns; zero: no such
    Eigen::Matrix3d inverse;  // of what turns cost
    Eigen::Vector3d turns;    // about the axes
    Eigen::Vector3d move, spin;
  };

  void add_freedoms(Link& link) const;
  bool look_at(const double* positions, const double* current);
  void place(const double* channels);
  void choose_freedoms();
  void aim();
  void aim_at_children(std::size_t bone);
  void carry(Link& link);
  double distance() const;
  void find_costs(double damping);
  Cost cost_at_parent(Link& link, double damping) const;
  double take_step(double damping);
  double find_motion(Link& link) const;
  Eigen::Vector3d root_motion(const Link& link) const;
  void turn_about_axes(Link& link) const;
  void keep(std::vector<Pose>& poses) const;
  void restore(const std::vector<Pose>& poses);
  void write(double* channels) const;
  Eigen::Matrix3d frame_of(const Link& link) const;
  Eigen::Matrix3d axes_of(const Link& link) const;

  std::vector<Link> links_;
  std::vector<std::vector<std::size_t>> children_;
  std::vector<Pose> kept_;
  double size_ = 0;  // of the body: the longest of its bones' ways from a root
};

}  // namespace moclean
