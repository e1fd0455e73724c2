#include "fitting/fit_verdict.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

bool IdentityVerdict::is_doubtful() const {
  constexpr double kLargest = 3.5;  // one of 34 people with 63 identities exceeds it
  // Slivers of a model flip even for people that it was made from: up to 6 of 13120, in 20 people.
  constexpr double kMostFlipped = 1e-3;
  return alpha_max > kLargest || flipped > kMostFlipped * triangles;
}

IdentityVerdict verdict_of(const MorphableModel& model, const Eigen::VectorXd& alpha) {
  IdentityVerdict verdict;
  if (alpha.size() == 0) return verdict;
  verdict.alpha_rms = std::sqrt(alpha.squaredNorm() / double(alpha.size()));
  verdict.alpha_max = alpha.cwiseAbs().maxCoeff();
  const Triangles& triangles = model.connectivity().triangles;
  const Positions neutral = triangle_normals(model.person(alpha).neutral(), triangles);
  const Positions mean = triangle_normals(model.mean(), triangles);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    verdict.flipped += neutral.row(t).dot(mean.row(t)) < 0;
  }
  verdict.triangles = static_cast<int>(triangles.rows());
  return verdict;
}

double FitResiduals::typical() const {
  std::vector<double> seen;
  std::ranges::copy_if(of_frames, std::back_inserter(seen),
                       [](double residual) { return !std::isnan(residual); });
  return seen.empty() ? 0 : median(std::move(seen));
}

FitResiduals residuals_of(const MeshSequence& sequence, const FittedCoefficients& fit,
                          const MappedLandmarks& mapped) {
  const auto landmarks = static_cast<Eigen::Index>(mapped.vertices.size());
  FitResiduals residuals{
      Eigen::VectorXd::Constant(fit.frames(), std::numeric_limits<double>::quiet_NaN()),
      Eigen::VectorXd::Zero(landmarks)};
  Eigen::VectorXd times_seen = Eigen::VectorXd::Zero(landmarks);
  for (int f = 0; f < fit.frames(); ++f) {
    if (fit.landmarks[f] == 0) continue;
    const Eigen::RowVector4d depth =
        fit.depths.rows() > 0 ? fit.depths.row(f) : Eigen::RowVector4d(0, 0, 0, 1);
    const ImagePoints expected =
        project(fit.cameras[static_cast<std::size_t>(f)],
                Positions(sequence.frame(f)(mapped.vertices, Eigen::all)), depth);
    const ImagePoints points = points_of_frame(mapped.points, f);
    std::vector<Eigen::Index> seen;
    for (Eigen::Index i = 0; i < landmarks; ++i) {
      if (!points.row(i).hasNaN()) seen.push_back(i);
    }
    if (seen.empty()) continue;
    const Eigen::VectorXd squares = (points - expected)(seen, Eigen::all).rowwise().squaredNorm();
    residuals.of_frames[f] = std::sqrt(squares.mean()) / rms_radius(points(seen, Eigen::all));
    residuals.of_landmarks(seen) += squares;
    times_seen(seen).array() += 1;
  }
  residuals.of_landmarks =
      (residuals.of_landmarks.array() / times_seen.array().max(1)).sqrt().matrix();
  return residuals;
}

double stretch_of(const std::vector<AffineCamera>& cameras, const FittedCoefficients& fit) {
  double sum = 0;
  int seen = 0;
  for (int f = 0; f < fit.frames(); ++f) {
    if (fit.landmarks[f] == 0) continue;
    const auto axes = cameras[static_cast<std::size_t>(f)].leftCols<3>();
    sum += std::log(axes.row(0).norm() / axes.row(1).norm());
    ++seen;
  }
  return seen > 0 ? std::exp(sum / seen) : 1;
}

bool ExpressionUse::is_constant() const {
  constexpr double kMean = 0.7, kShare = 0.5;
  return mean > kMean || at_one > kShare;
}

std::vector<ExpressionUse> expression_use(const Eigen::MatrixXd& beta) {
  std::vector<ExpressionUse> uses;
  for (const auto& column : beta.colwise()) {
    const double frames = double(column.size());
    uses.push_back({column.mean(), double((column.array() <= 0).count()) / frames,
                    double((column.array() >= 1).count()) / frames});
  }
  return uses;
}

std::vector<AffineCamera> cameras_at_origin(const FittedCoefficients& fit) {
  std::vector<AffineCamera> cameras = fit.cameras;
  for (Eigen::Index f = 0; f < fit.depths.rows(); ++f) {
    AffineCamera& camera = cameras[static_cast<std::size_t>(f)];
    camera.leftCols<3>() -= camera.col(3) * fit.depths.row(f).head<3>();
  }
  return cameras;
}

int averted_landmarks(const Positions& mesh, const Triangles& triangles,
                      const std::vector<int>& vertices, const AffineCamera& camera) {
  const Eigen::RowVector3d x = camera.row(0).head<3>(), y = camera.row(1).head<3>();
  const Eigen::RowVector3d away = x.cross(y);  // y points down in the image
  const Positions normals = triangle_normals(mesh, triangles);
  Eigen::VectorXd facing = Eigen::VectorXd::Zero(mesh.rows());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const double turned = normals.row(t).dot(away);
    for (int corner = 0; corner < 3; ++corner) facing[triangles(t, corner)] += turned;
  }
  return static_cast<int>(
      std::ranges::count_if(vertices, [&](int vertex) { return facing[vertex] > 0; }));
}

AvertedLandmarks::AvertedLandmarks(const MeshSequence& sequence, const FittedCoefficients& fit,
                                   const std::vector<int>& vertices,
                                   const std::vector<AffineCamera>& cameras)
    : of_frames_(cameras.size(), -1), landmarks_(static_cast<int>(vertices.size())) {
  for (int f = 0; f < fit.frames(); ++f) {
    if (fit.landmarks[f] == 0) continue;
    const auto frame = static_cast<std::size_t>(f);
    of_frames_[frame] =
        averted_landmarks(sequence.frame(f), sequence.triangles(), vertices, cameras[frame]);
  }
}

void AvertedLandmarks::require_facing(const std::string& name) const {
  const auto seen = std::ranges::count_if(of_frames_, [](int averted) { return averted >= 0; });
  const auto away =
      std::ranges::count_if(of_frames_, [&](int averted) { return 2 * averted > landmarks_; });
  if (2 * away <= seen) return;
  throw MismatchError(
      name + ": the face that fits looks away from the camera in " + std::to_string(away) + " of " +
      std::to_string(seen) +
      " frames, so the landmarks are mirrored; expected pixels from the upper left "
      "corner, x to the right and y down: where y points up take the image's height "
      "minus y, where the image was mirrored its width minus x");
}

std::vector<std::string> AvertedLandmarks::notes(const Invocation& invocation) const {
  const NamedData& landmarks = invocation.input("landmarks");
  std::vector<std::string> notes = landmarks.origin.frame_notes;
  std::vector<int> turned;
  notes.resize(of_frames_.size());
  for (std::size_t f = 0; f < of_frames_.size(); ++f) {
    if (4 * of_frames_[f] < landmarks_) continue;
    turned.push_back(static_cast<int>(f));
    std::string& note = notes[f];
    note += (note.empty() ? "" : "; ") + std::string("turned away: ") +
            std::to_string(of_frames_[f]) + " of " + std::to_string(landmarks_) +
            " landmarks are behind the face";
  }
  if (!turned.empty()) {
    invocation.warn(landmarks.name +
                    ": frames in which the head is turned so far that the hidden half of the face "
                    "is guessed: " +
                    listed(words_of(turned)));
  }
  const bool none =
      std::ranges::all_of(notes, [](const std::string& note) { return note.empty(); });
  return none ? std::vector<std::string>{} : notes;
}

Json Judgement::json(const std::vector<std::string>& names) const {
  Json uses = Json::array();
  for (std::size_t j = 0; j < expressions.size(); ++j) {
    const ExpressionUse& use = expressions[j];
    uses.push_back(
        {{"name", names[j]}, {"mean", use.mean}, {"at_zero", use.at_zero}, {"at_one", use.at_one}});
  }
  return {{"alpha_rms", identity.alpha_rms},
          {"alpha_max", identity.alpha_max},
          {"flipped", identity.flipped},
          {"residual", residuals.typical()},
          {"stretch", stretch},
          {"halves_mean", people.halves ? Json(people.halves->mean) : Json(nullptr)},
          {"halves_largest", people.halves ? Json(people.halves->largest) : Json(nullptr)},
          {"places_mean", people.places ? Json(people.places->mean) : Json(nullptr)},
          {"cuts", people.cuts},
          {"expressions", uses}};
}

std::string Judgement::words() const {
  std::string text = "identity: " + readable(identity.alpha_rms) +
                     " standard deviations (RMS), at most " + readable(identity.alpha_max) + ", " +
                     std::to_string(identity.flipped) + " flipped triangles";
  if (people.halves) {
    text += "; the neutrals of the clip's halves are " + readable(100 * people.halves->mean) +
            " % of the longest side apart (at most " + readable(100 * people.halves->largest) +
            " %)";
  }
  double at_bounds = 0;
  for (const ExpressionUse& use : expressions) {
    at_bounds += (use.at_zero + use.at_one) / double(expressions.size());
  }
  if (at_bounds > 0) {
    text += "; expressions are at a bound in " + readable(100 * at_bounds) + " % of the frames";
  }
  return text + '\n';
}

namespace {

/// Landmarks with the largest distances.
std::string farthest(const Eigen::VectorXd& distances, const MappedLandmarks& mapped) {
  constexpr std::size_t kNamed = 4;
  std::vector<std::size_t> order(mapped.names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&distances](std::size_t landmark) {
    return distances[static_cast<Eigen::Index>(landmark)];
  });
  std::vector<std::string> named;
  for (const std::size_t i : order) {
    if (named.size() == kNamed) break;
    named.push_back(mapped.names[i] + " by " +
                    readable(distances[static_cast<Eigen::Index>(i)], 3) + " px");
  }
  return joined(named);
}

void warn_of_residuals(const FitResiduals& residuals, bool has_identities,
                       const MappedLandmarks& mapped, const Invocation& invocation) {
  const std::string& name = invocation.input("landmarks").name;
  if (residuals.typical() > kFarLandmarks) {
    invocation.warn(name + ": the landmarks are " + percent(residuals.typical()) +
                    " of the face's radius from the fitted face, where a right fit has about 6 %; "
                    "the farthest are " +
                    farthest(residuals.of_landmarks, mapped) +
                    ": are they in the order of the mapping, and does it count the model's "
                    "vertices from 0?" +
                    (has_identities ? "" : " Or is it another face than the model's?"));
    return;
  }
  std::vector<int> far;
  for (Eigen::Index f = 0; f < residuals.of_frames.size(); ++f) {
    if (residuals.of_frames[f] > 2 * kFarLandmarks) far.push_back(static_cast<int>(f));
  }
  if (far.empty()) return;
  invocation.warn(name + ": frames whose landmarks are farther than " + percent(2 * kFarLandmarks) +
                  " of the face's radius from the fitted face, so that it is not theirs: " +
                  listed(words_of(far)));
}

void warn_of_stretch(double stretch, const Invocation& invocation) {
  if (stretch < kStretched && stretch > 1 / kStretched) return;
  const bool is_wide = stretch > 1;
  invocation.warn(invocation.input("landmarks").name + ": the images show the face " +
                  readable(is_wide ? stretch : 1 / stretch, 3) + " times as " +
                  (is_wide ? "wide" : "high") + " as it should be against its " +
                  (is_wide ? "height" : "width") +
                  ": are width and height of the images as they were said to be, and their pixels "
                  "square?");
}

void warn_of_people(const ClipPeople& people, const Invocation& invocation) {
  const std::string& name = invocation.input("landmarks").name;
  if (people.places && people.places->mean > kTwoPeople) {
    invocation.warn(name + ": the face jumps to another place in frames " +
                    listed(words_of(people.cuts)) + ", and the places give two faces, " +
                    percent(people.places->mean) +
                    " of the longest side apart on average, where one person's are below 1.9 %: "
                    "are they two people? Fit each alone: --frames takes a part");
  } else if (people.halves && people.halves->mean > kTwoPeople) {
    invocation.warn(name + ": the halves of the clip give two faces, " +
                    percent(people.halves->mean) +
                    " of the longest side apart on average, where one "
                    "person's are below 1.2 %: is it one person, without a cut? --frames takes a "
                    "part");
  }
}

/// Options that may make the identity plausible.
std::string advice(const FitOptions& options, bool is_clip) {
  using Camera = FitOptions::Camera;
  const bool is_affine =
      options.camera == Camera::affine || (options.camera == Camera::automatic && !is_clip);
  std::string text = "use more frames in which the head turns";
  if (is_affine) text += ", --camera orthographic";
  if (options.camera != Camera::perspective) {
    text += ", --camera perspective with the --focal-length where the face is near";
  }
  return text + ", a --repeated nearer to 1 or a larger --sigma";
}

}  // namespace

void warn_of(const Judgement& judgement, const std::vector<std::string>& names,
             const MappedLandmarks& mapped, const FitOptions& options,
             const Invocation& invocation) {
  warn_of_residuals(judgement.residuals, judgement.has_identities, mapped, invocation);
  const bool is_clip = mapped.points.rows() > 1;
  if (is_clip && judgement.has_identities) warn_of_stretch(judgement.stretch, invocation);
  warn_of_people(judgement.people, invocation);
  const IdentityVerdict& identity = judgement.identity;
  if (identity.is_doubtful()) {
    invocation.warn("the fitted identity is hardly a person: its largest coefficient is " +
                    readable(identity.alpha_max) + " standard deviations, and " +
                    std::to_string(identity.flipped) + " of " + std::to_string(identity.triangles) +
                    " triangles are flipped; " + advice(options, is_clip));
  }
  std::string constant;
  for (std::size_t j = 0; j < names.size(); ++j) {
    if (!judgement.expressions[j].is_constant()) continue;
    constant += (constant.empty() ? "" : ", ") + names[j] + " (" +
                readable(judgement.expressions[j].mean) + ")";
  }
  if (!constant.empty() && judgement.people.halves) {
    invocation.warn("expressions that are there all the time, as parts of the face are: " +
                    constant + "; a larger --ridge makes them smaller");
  }
}

}  // namespace mimetra
