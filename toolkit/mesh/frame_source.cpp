#include "toolkit/mesh/frame_source.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace {

void check_run(const FrameSource& source, int first, Eigen::Index count) {
  if (first >= 0 && count >= 0 && first + count <= source.frames()) return;
  throw std::out_of_range("frames " + std::to_string(first) + " to " +
                          std::to_string(first + count - 1) + " of a sequence of " +
                          std::to_string(source.frames()));
}

/// Some frames of another source.
class SelectedFrames : public FrameSource {
 public:
  SelectedFrames(std::shared_ptr<const FrameSource> source, std::vector<int> chosen)
      : FrameSource(source->header()), source_(std::move(source)), chosen_(std::move(chosen)) {
    for (const int frame : chosen_) check_run(*source_, frame, 1);
    header_.times = source_->times()(chosen_);
    if (rest_is_known() || chosen_.empty()) return;
    const Frames first = source_->read(chosen_.front(), 1);
    header_.rest = PositionsView(first.data(), vertices(), 3);
  }

 private:
  /// Neighbours are read together.
  void read_frames(int first, FramesView poses) const override {
    for (Eigen::Index row = 0; row < poses.rows();) {
      const int start = chosen_at(first + row);
      Eigen::Index count = 1;
      while (row + count < poses.rows() && chosen_at(first + row + count) == start + count) ++count;
      source_->read(start, FramesView(poses.row(row).data(), count, poses.cols()));
      row += count;
    }
  }

  int chosen_at(Eigen::Index frame) const { return chosen_[static_cast<std::size_t>(frame)]; }

  std::shared_ptr<const FrameSource> source_;
  std::vector<int> chosen_;
};

/// As many as fit a block, but enough blocks for threads to share.
int frames_in_block(const FrameSource& source) {
  constexpr int kBlocks = 64;
  const std::size_t frame = std::max<std::size_t>(1, 3 * sizeof(double) * source.vertices());
  // Readers and writers hold a block up to three times more, in their own encodings.
  const auto most = static_cast<int>(std::min<std::size_t>(kBlockBytes / 4 / frame, 1 << 20));
  const int wanted = std::min(most, source.frames() / kBlocks + 1);
  // Products of matrices take rows in fours.
  return most < 4 ? std::max(1, wanted) : std::max(4, wanted / 4 * 4);
}

}  // namespace

Eigen::VectorXd default_times(int frames) {
  return Eigen::VectorXd::LinSpaced(frames, 0, static_cast<double>(frames - 1)) /
         kDefaultFramesPerSecond;
}

void FrameSource::read(int first, FramesView poses) const {
  check_run(*this, first, poses.rows());
  if (poses.cols() != 3 * Eigen::Index{vertices()}) {
    throw std::invalid_argument("room for " + std::to_string(poses.cols()) +
                                " coordinates a frame, expected 3 x " + std::to_string(vertices()) +
                                " vertices");
  }
  if (poses.rows() > 0) read_frames(first, poses);
}

Frames FrameSource::read(int first, int count) const {
  check_run(*this, first, count);
  Frames poses(count, 3 * Eigen::Index{vertices()});
  read(first, FramesView(poses.data(), poses.rows(), poses.cols()));
  return poses;
}

std::shared_ptr<const FrameSource> selected(std::shared_ptr<const FrameSource> source,
                                            std::vector<int> chosen) {
  return std::make_shared<const SelectedFrames>(std::move(source), std::move(chosen));
}

void for_each_run(const FrameSource& source, const BlockOptions& options,
                  const std::function<void(int, int)>& work) {
  const int size = frames_in_block(source);
  const auto work_on = [&](int block) {
    const int first = block * size;
    work(first, std::min(size, source.frames() - first));
  };
  parallel_for((source.frames() + size - 1) / size, options.threads, work_on, options.progress);
}

void for_each_block(const FrameSource& source, const BlockOptions& options,
                    const std::function<void(int, const Frames&)>& work) {
  for_each_run(source, options,
               [&](int first, int count) { work(first, source.read(first, count)); });
}

double motion(const FrameSource& source, const BlockOptions& options) {
  // One sum a frame, added in their order: the same for every number of threads.
  Eigen::VectorXd squares(source.frames());
  for_each_block(source, options, [&](int first, const Frames& poses) {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const PositionsView pose(poses.row(row).data(), source.vertices(), 3);
      squares[first + row] = (pose - source.rest()).squaredNorm();
    }
  });
  double sum = 0;
  for (const double square : squares) sum += square;
  const double points = static_cast<double>(source.frames()) * source.vertices();
  return points > 0 ? std::sqrt(sum / points) : 0;
}

}  // namespace mimetra
