#include <algorithm>
#include <any>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "moclean/core/error.hpp"
#include "moclean/formats/amc.hpp"
#include "moclean/formats/bone_finder.hpp"
#include "moclean/formats/channel_text.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/formats/text_scanner.hpp"
#include "moclean/motion/framed_source.hpp"
#include "moclean/motion/inverse_kinematics.hpp"

namespace moclean {
namespace {

// The frames of a document as it was read, in which numbers that have changed are replaced.
class AmcWriter {
 public:
  AmcWriter(AtomicFile& file, const AmcDocument& document, const Skeleton& skeleton)
      : file_(file),
        document_(document),
        bones_(skeleton.bones),
        finder_(bones_),
        rows_(std::string_view(document.text).substr(document.rows)),
        scanner_(rows_, file.target(), {.comment = '#'}) {
    for (const Bone& bone : bones_) {
      first_channel_.push_back(width_);
      width_ += static_cast<Index>(bone.channels.size());
    }
    learn_spelling();
  }

  // `channels` are those of the document's frames from `first` on.
  void write(Index first, const Matrix& channels) {
    text_ = document_.text.substr(0, document_.rows);
    for (Index f = 0; f < first; ++f) frame(nullptr);
    scanner_.peek();
    done_ = place();
    for (Index f = 0; f < channels.rows(); ++f) {
      frame(channels.row(f).data());
      write_if_full(file_, text_);
    }
    scanner_.peek();  // to the next frame
    text_ += rows_.substr(done_, place() - done_);
    file_.write(text_);
  }

 private:
  std::size_t place() const { return rows_.size() - scanner_.bytes_left(); }

  bool at_frame_number() {
    const char c = scanner_.peek();
    return c >= '0' && c <= '9';
  }

  void frame(const double* values) {
    scanner_.word();  // its number
    while (!scanner_.at_end() && !at_frame_number()) {
      const std::size_t bone = finder_.find(scanner_.word()).value();
      const std::vector<Channel>& channels = bones_[bone].channels;
      for (std::size_t c = channels.size(); c-- > 0;) {  // reversed, as AmcParser reads them
        const std::string_view word = scanner_.word();
        if (values) number(word, channels[c], values[first_channel_[bone] + static_cast<Index>(c)]);
      }
    }
  }

  void number(std::string_view word, Channel channel, double value) {
    const double scale = is_translation(channel) ? 1 : document_.radians_per_angle;
    if (std::isnan(value) || channel_number(word) * scale == value) return;
    const auto first = static_cast<std::size_t>(word.data() - rows_.data());
    text_ += rows_.substr(done_, first - done_);
    spelling_.put(value / scale, text_);
    done_ = first + word.size();
  }

  // That of the first numbers.
  void learn_spelling() {
    constexpr int words = 4000;
    TextScanner scanner(rows_, file_.target(), {.comment = '#'});
    for (int w = 0; w < words && !scanner.at_end(); ++w) spelling_.learn(scanner.word());
  }

  AtomicFile& file_;
  const AmcDocument& document_;
  const std::vector<Bone>& bones_;
  BoneFinder finder_;
  std::string_view rows_;
  TextScanner scanner_;
  std::vector<Index> first_channel_;  // per bone
  Index width_ = 0;
  ChannelSpelling spelling_;
  std::size_t done_ = 0;  // of rows_: what is in text_ or left out
  std::string text_;
};

[[noreturn]] void fail_without_document(const AtomicFile& file) {
  throw FileError(file.target(),
                  "cannot be written: AMC holds rotations of an ASF skeleton, and only a recording "
                  "read from an AMC file has them; rotations of others go into .bvh, positions "
                  "into " +
                      any_extension(holds_any_samples));
}

}  // namespace

void write_amc(AtomicFile& file, const Recording& recording) {
  const auto* const source = std::any_cast<FramedSource>(&recording.source);
  const auto* const document =
      source ? std::any_cast<std::shared_ptr<const AmcDocument>>(&source->file) : nullptr;
  if (!document || !recording.skeleton || joint_parents(recording).empty() ||
      recording.channels.rows() != recording.frames() ||
      recording.channels.cols() != recording.skeleton->channels() ||
      source->first + recording.frames() > (*document)->frames)
    fail_without_document(file);
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const Matrix channels =
      inverse_kinematics(*recording.skeleton, recording.channels, recording.samples, threads);
  AmcWriter(file, **document, *recording.skeleton).write(source->first, channels);
}

}  // namespace moclean
