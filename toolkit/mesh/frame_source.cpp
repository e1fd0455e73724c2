#include "toolkit/mesh/frame_source.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace {

class SelectedFrames : public FrameSource {
 public:
  SelectedFrames(std::shared_ptr<const FrameSource> source, std::vector<int> chosen)
      : FrameSource(source->header()), source_(std::move(source)), chosen_(std::move(chosen)) {
    for (const int frame : chosen_) source_->check_run(frame, 1);
    header_.times = source_->times()(chosen_);
    if (rest_is_known() || chosen_.empty()) return;
    const Frames first = source_->read(chosen_.front(), 1);
    header_.rest = PositionsView(first.data(), vertices(), 3);
  }

  bool is_quick() const override { return source_->is_quick(); }
  bool reads_vertices() const override { return source_->reads_vertices(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    for_each_stretch(first, poses, [this](int start, FramesView neighbours) {
      source_->read(start, neighbours);
    });
  }

  void read_some_vertices(int first, VertexIndex vertex, FramesView poses) const override {
    for_each_stretch(first, poses, [this, vertex](int start, FramesView neighbours) {
      source_->read_vertices(start, vertex, neighbours);
    });
  }

  /// Reads consecutive frames together.
  template <typename Read>
  void for_each_stretch(int first, FramesView poses, const Read& read) const {
    for (Eigen::Index row = 0; row < poses.rows();) {
      const int start = chosen_at(first + row);
      Eigen::Index count = 1;
      while (row + count < poses.rows() && chosen_at(first + row + count) == start + count) ++count;
      read(start, FramesView(poses.row(row).data(), count, poses.cols()));
      row += count;
    }
  }

  int chosen_at(Eigen::Index frame) const { return chosen_[static_cast<std::size_t>(frame)]; }

  std::shared_ptr<const FrameSource> source_;
  std::vector<int> chosen_;
};

/// Poses of another source under another header with as many vertices and frames.
class FramesUnderHeader : public FrameSource {
 public:
  FramesUnderHeader(std::shared_ptr<const FrameSource> source, SequenceHeader header)
      : FrameSource(std::move(header)), source_(std::move(source)) {}

  std::shared_ptr<const Frames> in_memory() const override { return source_->in_memory(); }
  bool is_quick() const override { return source_->is_quick(); }
  bool reads_vertices() const override { return source_->reads_vertices(); }

 private:
  void read_frames(int first, FramesView poses) const override { source_->read(first, poses); }
  void read_some_vertices(int first, VertexIndex vertex, FramesView poses) const override {
    source_->read_vertices(first, vertex, poses);
  }

  std::shared_ptr<const FrameSource> source_;
};

class VertexFrames : public FrameSource {
 public:
  VertexFrames(std::shared_ptr<const FrameSource> source, VertexIndex first, int count)
      : FrameSource(source->header()), source_(std::move(source)), first_(first) {
    source_->check_vertices(first, count);
    Connectivity points;
    points.vertices = count;
    header_.connectivity = std::make_shared<const Connectivity>(std::move(points));
    header_.rest = Positions(source_->rest().middleRows(first, count));
  }

  bool is_quick() const override { return source_->is_quick(); }
  bool reads_vertices() const override { return source_->reads_vertices(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    source_->read_vertices(first, first_, poses);
  }
  void read_some_vertices(int first, VertexIndex vertex, FramesView poses) const override {
    source_->read_vertices(first, first_ + vertex, poses);
  }

  std::shared_ptr<const FrameSource> source_;
  VertexIndex first_;
};

/// Number of frames, each of this many numbers, that fit into `bytes`.
int frames_in(std::size_t bytes, Eigen::Index numbers) {
  const std::size_t frame =
      sizeof(double) * static_cast<std::size_t>(std::max<Eigen::Index>(1, numbers));
  return static_cast<int>(std::min<std::size_t>(bytes / frame, 1 << 20));
}

Eigen::Index numbers_of_pose(const FrameSource& source) {
  return 3 * Eigen::Index{source.vertices()};
}

/// Rounds `wanted` frames to a multiple of four if `most` allows it: matrix products take rows in
/// fours.
int in_fours(int wanted, int most) {
  return most < 4 ? std::max(1, wanted) : std::max(4, wanted / 4 * 4);
}

/// Number of frames in a block: as many as fit, but few enough to give all threads work.
int frames_in_block(const FrameSource& source, Eigen::Index numbers) {
  constexpr int kBlocks = 64;
  // Readers and writers hold a block up to three more times, in their own encodings.
  const int most = frames_in(kBlockBytes / 4, numbers);
  return in_fours(std::min(most, source.frames() / kBlocks + 1), most);
}

}  // namespace

Eigen::VectorXd default_times(int frames) {
  return Eigen::VectorXd::LinSpaced(frames, 0, static_cast<double>(frames - 1)) /
         kDefaultFramesPerSecond;
}

void FrameSource::check_run(int first, Eigen::Index count) const {
  if (first >= 0 && count >= 0 && first + count <= frames()) return;
  throw std::out_of_range("frames " + std::to_string(first) + " to " +
                          std::to_string(first + count - 1) + " of a sequence of " +
                          std::to_string(frames()));
}

void FrameSource::read(int first, FramesView poses) const {
  check_run(first, poses.rows());
  if (poses.cols() != 3 * Eigen::Index{vertices()}) {
    throw std::invalid_argument("room for " + std::to_string(poses.cols()) +
                                " coordinates a frame, expected 3 x " + std::to_string(vertices()) +
                                " vertices");
  }
  if (poses.rows() > 0) read_frames(first, poses);
}

Frames FrameSource::read(int first, int count) const {
  check_run(first, count);
  Frames poses(count, 3 * Eigen::Index{vertices()});
  read(first, FramesView(poses.data(), poses.rows(), poses.cols()));
  return poses;
}

void FrameSource::check_vertices(VertexIndex first, Eigen::Index count) const {
  if (first >= 0 && count >= 0 && first + count <= vertices()) return;
  throw std::out_of_range("vertices " + std::to_string(first) + " to " +
                          std::to_string(first + count - 1) + " of a mesh of " +
                          std::to_string(vertices()));
}

void FrameSource::read_vertices(int first, VertexIndex vertex, FramesView poses) const {
  check_run(first, poses.rows());
  if (poses.cols() % 3 != 0) {
    throw std::invalid_argument("room for " + std::to_string(poses.cols()) +
                                " coordinates a frame, expected three a vertex");
  }
  check_vertices(vertex, poses.cols() / 3);
  if (poses.size() > 0) read_some_vertices(first, vertex, poses);
}

void FrameSource::read_some_vertices(int first, VertexIndex vertex, FramesView poses) const {
  for (Eigen::Index row = 0; row < poses.rows(); ++row) {
    const FrameBlock frame(*this, first + static_cast<int>(row), 1);
    poses.row(row) = frame.poses().row(0).segment(3 * vertex, poses.cols());
  }
}

FrameBlock::FrameBlock(const FrameSource& source, int first, int count)
    : poses_(nullptr, 0, 3 * Eigen::Index{source.vertices()}) {
  const Frames* all = source.in_memory().get();
  if (all) {
    source.check_run(first, count);
  } else {
    read_ = source.read(first, count);
  }
  const double* data = all ? all->data() + first * all->cols() : read_.data();
  new (&poses_) Eigen::Map<const Frames>(data, count, poses_.cols());
}

PositionsView FrameBlock::frame(int row) const {
  return {poses_.data() + row * poses_.cols(), poses_.cols() / 3, 3};
}

std::shared_ptr<const FrameSource> selected(std::shared_ptr<const FrameSource> source,
                                            std::vector<int> chosen) {
  return std::make_shared<const SelectedFrames>(std::move(source), std::move(chosen));
}

std::shared_ptr<const FrameSource> with_rest(std::shared_ptr<const FrameSource> source,
                                             std::optional<Positions> rest) {
  SequenceHeader header = source->header();
  header.rest_is_known = rest.has_value();
  if (rest) {
    header.rest = *std::move(rest);
  } else if (source->frames() > 0) {
    header.rest = FrameBlock(*source, 0, 1).frame(0);
  }
  if (header.rest.rows() != source->vertices()) {
    throw std::invalid_argument("the rest pose has " + std::to_string(header.rest.rows()) +
                                " vertices, expected " + std::to_string(source->vertices()) +
                                " as in the frames");
  }
  return std::make_shared<const FramesUnderHeader>(std::move(source), std::move(header));
}

std::shared_ptr<const FrameSource> some_vertices(std::shared_ptr<const FrameSource> source,
                                                 VertexIndex first, int count) {
  return std::make_shared<const VertexFrames>(std::move(source), first, count);
}

void for_each_run(const FrameSource& source, const std::function<void(int, int)>& work,
                  const Context& context) {
  const int size = frames_in_block(source, numbers_of_pose(source));
  const auto work_on = [&](int block) {
    const int first = block * size;
    work(first, std::min(size, source.frames() - first));
  };
  parallel_for((source.frames() + size - 1) / size, work_on, context);
}

void for_each_block(const FrameSource& source, const std::function<void(int, const Frames&)>& work,
                    const Context& context) {
  context.for_each_block(
      source.frames(), frames_in_block(source, numbers_of_pose(source)), numbers_of_pose(source),
      [&source](int first, int count) { return source.read(first, count); }, work);
}

FrameNumbers over_frames(const FrameSource& source, Eigen::Index summed, Eigen::Index kept,
                         const std::function<void(int, const FrameBlock&, FrameRows&)>& work,
                         const Context& context) {
  constexpr int kFewest = 8;  // so that threads can share them
  const Eigen::Index columns = summed + kept;
  const Eigen::Index numbers = std::max(numbers_of_pose(source), columns);
  const int most = std::max(kFewest, frames_in(kBlockBytes, numbers)) * context.ranks().count();
  // Numbers that are only kept are already in place.
  const int held = summed > 0 ? in_fours(most, most) : std::max(1, source.frames());
  const int at_once = frames_in_block(source, numbers);
  FrameRows summands(std::min(held, source.frames()), summed);
  FrameNumbers result{Eigen::VectorXd::Zero(summed), FrameRows(source.frames(), kept)};
  for (int start = 0; start < source.frames(); start += held) {
    const double done = static_cast<double>(start) / source.frames();
    const int count = std::min(held, source.frames() - start);
    context.part(done, static_cast<double>(start + count) / source.frames())
        .for_each_block(
            count, at_once, columns,
            [&](int first, int rows) {
              const FrameBlock block(source, start + first, rows);
              FrameRows found = FrameRows::Zero(rows, columns);
              work(start + first, block, found);
              return found;
            },
            [&](int first, const FrameRows& found) {
              summands.middleRows(first, found.rows()) = found.leftCols(summed);
              result.of_each.middleRows(start + first, found.rows()) = found.rightCols(kept);
            });
    for (int row = 0; row < count; ++row) result.sum += summands.row(row).transpose();
  }
  context.report(1);
  return result;
}

Positions mean_pose(const FrameSource& source) {
  if (source.frames() == 0) return {};
  // Eigen sums rows by taking the first and adding the others in fours. Summing blocks of fours
  // that start with the sum so far gives the same bits.
  const int held = 4 * std::max(1, frames_in(kBlockBytes, numbers_of_pose(source)) / 4);
  Frames rows(1 + std::min(held, source.frames() - 1), 3 * Eigen::Index{source.vertices()});
  source.read(0, FramesView(rows.data(), 1, rows.cols()));
  for (int first = 1; first < source.frames(); first += held) {
    const int count = std::min(held, source.frames() - first);
    source.read(first, FramesView(rows.row(1).data(), count, rows.cols()));
    const Eigen::RowVectorXd sum = rows.topRows(1 + count).colwise().sum();
    rows.row(0) = sum;
  }
  rows.row(0) /= source.frames();
  return PositionsView(rows.data(), source.vertices(), 3);
}

double motion(const FrameSource& source, const Context& context) {
  // Adds one sum per frame in order, so that the result does not depend on the number of threads.
  Eigen::VectorXd squares(source.frames());
  const auto add_squares = [&](int first, const Frames& poses) {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const PositionsView pose(poses.row(row).data(), source.vertices(), 3);
      squares[first + row] = (pose - source.rest()).squaredNorm();
    }
  };
  for_each_block(source, add_squares, context);
  double sum = 0;
  for (const double square : squares) sum += square;
  const double points = static_cast<double>(source.frames()) * source.vertices();
  return points > 0 ? std::sqrt(sum / points) : 0;
}

}  // namespace mimetra
