#include "fitting/fit_judgement.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include <nlohmann/json.hpp>

#include "toolkit/mesh/text.h"

namespace mimetra {

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

/// The landmarks that are farthest off, with their distance.
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
  return mimetra::joined(named);
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

/// What may make a person of it.
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
