#include "moclean/body/local_frame.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace moclean {

RigidMotion rigid_motion(const BodyTake& take, const Neighbours& neighbours, Index from, Index to) {
  RigidMotion motion{{}, Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero()};
  double total = 0;
  for (const auto& [k, weight] : neighbours) {
    motion.from += weight * take.position(from, k);
    motion.to += weight * take.position(to, k);
    total += weight;
  }
  motion.from /= total;
  motion.to /= total;
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  for (const auto& [k, weight] : neighbours)
    h += weight * (take.position(from, k) - motion.from).transpose() *
         (take.position(to, k) - motion.to);
  // The quaternion of the rotation is the eigenvector of the largest eigenvalue.
  Eigen::Matrix4d q;
  q(0, 0) = h.trace();
  q.bottomLeftCorner<3, 1>() << h(1, 2) - h(2, 1), h(2, 0) - h(0, 2), h(0, 1) - h(1, 0);
  q.bottomRightCorner<3, 3>() = h + h.transpose() - h.trace() * Eigen::Matrix3d::Identity();
  const Eigen::Vector4d v = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(q).eigenvectors().col(3);
  motion.rotation = Eigen::Quaterniond(v(0), v(1), v(2), v(3)).toRotationMatrix();
  return motion;
}

}  // namespace moclean
