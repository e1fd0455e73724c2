#include <stdexcept>
#include <string>
#include <utility>

#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

void check_frames(const Frames& frames, int vertices) {
  if (frames.rows() < 1) throw std::invalid_argument("a sequence needs at least one frame");
  if (frames.cols() != 3 * static_cast<Eigen::Index>(vertices)) {
    throw std::invalid_argument("frames have " + std::to_string(frames.cols()) +
                                " coordinates, expected 3 x " + std::to_string(vertices) +
                                " vertices of the connectivity");
  }
}

void check_rest(const Positions& rest, int vertices) {
  if (rest.rows() != vertices) {
    throw std::invalid_argument("the rest pose has " + std::to_string(rest.rows()) +
                                " vertices, expected " + std::to_string(vertices) +
                                " as in the frames");
  }
}

void check_times(const Eigen::VectorXd& times) {
  for (Eigen::Index f = 1; f < times.size(); ++f) {
    if (times[f] > times[f - 1]) continue;
    throw std::invalid_argument("frame " + std::to_string(f) + " is at " + readable(times[f]) +
                                " s, expected more than " + readable(times[f - 1]) +
                                " s of the frame before");
  }
}

}  // namespace

MeshSequence::MeshSequence(Connectivity connectivity, Frames frames, Eigen::VectorXd times,
                           std::optional<Positions> rest)
    : MeshSequence(std::make_shared<const Connectivity>(std::move(connectivity)), std::move(frames),
                   std::move(times), std::move(rest)) {}

MeshSequence::MeshSequence(std::shared_ptr<const Connectivity> connectivity, Frames frames,
                           Eigen::VectorXd times, std::optional<Positions> rest)
    : MeshSequence(std::move(connectivity), std::make_shared<const Frames>(std::move(frames)),
                   std::move(times), std::move(rest)) {}

MeshSequence::MeshSequence(std::shared_ptr<const Connectivity> connectivity,
                           std::shared_ptr<const Frames> frames, Eigen::VectorXd times,
                           std::optional<Positions> rest)
    : FrameSource({std::move(connectivity), std::move(times), {}, rest.has_value()}),
      frames_(std::move(frames)) {
  if (!header_.connectivity) throw std::invalid_argument("a sequence needs a connectivity");
  check_frames(*frames_, vertices());
  const auto count = static_cast<int>(frames_->rows());
  header_.times_are_known = header_.times.size() > 0;
  if (!times_are_known()) header_.times = default_times(count);
  if (this->frames() != count) {
    throw std::invalid_argument(std::to_string(this->frames()) + " times for " +
                                std::to_string(count) + " frames");
  }
  check_times(header_.times);
  header_.rest = rest ? *std::move(rest) : Positions(frame(0));
  check_rest(header_.rest, vertices());
}

MeshSequence::MeshSequence(const FrameSource& source, const Context& context)
    : FrameSource(source), frames_(source.in_memory()) {
  if (frames_) return;
  auto all = std::make_shared<Frames>(source.frames(), 3 * Eigen::Index{vertices()});
  for_each_run(
      source,
      [&](int first, int count) {
        source.read(first, FramesView(all->row(first).data(), count, all->cols()));
      },
      context);
  frames_ = std::move(all);
}

PositionsView MeshSequence::frame(int f) const {
  return {frames_->data() + f * frames_->cols(), vertices(), 3};
}

MeshSequence MeshSequence::slice(int first, int last, int step) const {
  if (first < 0 || first >= last || last > frames() || step < 1) {
    throw std::invalid_argument("frames " + std::to_string(first) + ":" + std::to_string(last) +
                                ":" + std::to_string(step) + " of a sequence of " +
                                std::to_string(frames()) +
                                ", expected 0 <= first < last <= frames and step >= 1");
  }
  const auto chosen = Eigen::seq(first, last - 1, step);
  std::optional<Positions> rest;
  if (rest_is_known()) rest = this->rest();
  MeshSequence part(shared_connectivity(), Frames((*frames_)(chosen, Eigen::all)), times()(chosen),
                    std::move(rest));
  part.header_.times_are_known = times_are_known();
  return part;
}

MeshSequence MeshSequence::with_rest(Positions rest) const {
  return {shared_connectivity(), frames_, known_times(), std::move(rest)};
}

MeshSequence MeshSequence::with_frames(Frames frames) const {
  check_frames(frames, vertices());
  if (frames.rows() != frames_->rows()) {
    throw std::invalid_argument(std::to_string(frames.rows()) + " frames, expected " +
                                std::to_string(frames_->rows()) + " as in the sequence");
  }
  MeshSequence result = *this;
  result.frames_ = std::make_shared<const Frames>(std::move(frames));
  return result;
}

void MeshSequence::read_frames(int first, FramesView poses) const {
  poses = frames_->middleRows(first, poses.rows());
}

void MeshSequence::read_some_vertices(int first, VertexIndex vertex, FramesView poses) const {
  poses = frames_->block(first, 3 * Eigen::Index{vertex}, poses.rows(), poses.cols());
}

}  // namespace mimetra
