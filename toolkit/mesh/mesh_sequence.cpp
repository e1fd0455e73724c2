#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {
namespace {

Positions as_positions(const Eigen::RowVectorXd& row) {
  return PositionsView(row.data(), row.size() / 3, 3);
}

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

Eigen::VectorXd default_times(Eigen::Index frames) {
  return Eigen::VectorXd::LinSpaced(frames, 0, static_cast<double>(frames - 1)) /
         kDefaultFramesPerSecond;
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
    : connectivity_(std::move(connectivity)),
      frames_(std::move(frames)),
      times_(std::move(times)),
      rest_is_known_(rest.has_value()) {
  if (!connectivity_) throw std::invalid_argument("a sequence needs a connectivity");
  check_frames(*frames_, connectivity_->vertices);
  if (times_.size() == 0) times_ = default_times(frames_->rows());
  if (times_.size() != frames_->rows()) {
    throw std::invalid_argument(std::to_string(times_.size()) + " times for " +
                                std::to_string(frames_->rows()) + " frames");
  }
  rest_ = rest ? *std::move(rest) : Positions(frame(0));
  check_rest(rest_, vertices());
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
  if (rest_is_known_) rest = rest_;
  return {connectivity_, Frames((*frames_)(chosen, Eigen::all)), times_(chosen), std::move(rest)};
}

MeshSequence MeshSequence::with_rest(Positions rest) const {
  return {connectivity_, frames_, times_, std::move(rest)};
}

MeshSequence MeshSequence::with_frames(Frames frames) const {
  check_frames(frames, vertices());
  if (frames.rows() != frames_->rows()) {
    throw std::invalid_argument(std::to_string(frames.rows()) + " frames, expected " +
                                std::to_string(frames_->rows()) + " as in the sequence");
  }
  MeshSequence result;
  result.connectivity_ = connectivity_;
  result.frames_ = std::make_shared<const Frames>(std::move(frames));
  result.times_ = times_;
  result.rest_ = rest_;
  result.rest_is_known_ = rest_is_known_;
  return result;
}

Positions mean_pose(const MeshSequence& sequence) {
  if (sequence.frames() == 0) return {};
  return as_positions(sequence.positions().colwise().mean());
}

double motion(const MeshSequence& sequence) {
  double sum = 0;
  for (int f = 0; f < sequence.frames(); ++f) {
    sum += (sequence.frame(f) - sequence.rest()).squaredNorm();
  }
  const double points = static_cast<double>(sequence.frames()) * sequence.vertices();
  return points > 0 ? std::sqrt(sum / points) : 0;
}

}  // namespace mimetra
