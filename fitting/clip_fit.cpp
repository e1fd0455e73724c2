#include "fitting/clip_fit.h"

#include <map>
#include <numeric>
#include <utility>

#include "fitting/followed_face.h"

namespace mimetra {

NeutralDistance neutral_distance(const MorphableModel& model, const Eigen::VectorXd& a,
                                 const Eigen::VectorXd& b) {
  const Eigen::VectorXd distances =
      (model.person(a).neutral() - model.person(b).neutral()).rowwise().norm();
  const Eigen::RowVector3d box =
      model.mean().colwise().maxCoeff() - model.mean().colwise().minCoeff();
  return {distances.mean() / box.maxCoeff(), distances.maxCoeff() / box.maxCoeff()};
}

namespace {

/// With fewer frames, the neutrals of one person differ by up to 2.8 %.
constexpr std::size_t kFewestOfPlace = 75;

std::vector<int> frames_between(int from, int to) {
  std::vector<int> frames(static_cast<std::size_t>(to - from));
  std::iota(frames.begin(), frames.end(), from);
  return frames;
}

std::optional<NeutralDistance> halves_distance(const ClipFit& clip, const FittedCoefficients& fit,
                                               const Context& context) {
  constexpr int kFewestOfHalf = 10;
  const int frames = fit.frames(), half = frames / 2;
  const bool enough = (fit.landmarks.head(half).array() > 0).count() >= kFewestOfHalf &&
                      (fit.landmarks.tail(frames - half).array() > 0).count() >= kFewestOfHalf;
  if (!enough) return {};
  const auto alpha = [&](int from, int to, const Context& part) {
    return clip.of(frames_between(from, to), part).front().alpha;
  };
  const Eigen::VectorXd first = alpha(0, half, context.part(0, 0.5));
  const Eigen::VectorXd second = alpha(half, frames, context.part(0.5, 1));
  return neutral_distance(clip.model(), first, second);
}

/// Groups frames with landmarks by the place of the face in the image.
std::map<int, std::vector<int>> frames_of_places(const MappedLandmarks& mapped,
                                                 const FittedCoefficients& fit,
                                                 std::vector<int>& cuts) {
  std::vector<std::vector<FaceBox>> boxes(static_cast<std::size_t>(fit.frames()));
  for (int f = 0; f < fit.frames(); ++f) {
    if (fit.landmarks[f] == 0) continue;
    boxes[static_cast<std::size_t>(f)].push_back(box_around(points_of_frame(mapped.points, f)));
  }
  std::map<int, std::vector<int>> frames;
  int last = 0;
  const std::vector<std::vector<int>> places = face_places(boxes);
  for (int f = 0; f < fit.frames(); ++f) {
    for (const int place : places[static_cast<std::size_t>(f)]) {
      frames[place].push_back(f);
      if (place != last) cuts.push_back(f);
      last = place;
    }
  }
  return frames;
}

/// Largest distance between the neutrals of places with enough frames; empty if fewer than two
/// places have enough.
std::optional<NeutralDistance> places_distance(const ClipFit& clip,
                                               std::map<int, std::vector<int>> frames,
                                               const Context& context) {
  std::erase_if(frames, [](const auto& place) { return place.second.size() < kFewestOfPlace; });
  if (frames.size() < 2) return {};
  std::vector<Eigen::VectorXd> alphas;
  const double share = 1 / static_cast<double>(frames.size());
  for (const auto& [place, of_place] : frames) {
    const double from = share * static_cast<double>(alphas.size());
    alphas.push_back(clip.of(of_place, context.part(from, from + share)).front().alpha);
  }
  NeutralDistance largest;
  for (std::size_t a = 0; a < alphas.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const NeutralDistance distance = neutral_distance(clip.model(), alphas[a], alphas[b]);
      if (distance.mean > largest.mean) largest = distance;
    }
  }
  return largest;
}

}  // namespace

ClipFit::ClipFit(const MorphableModel& model, const MappedLandmarks& mapped, Eigen::VectorXd times,
                 FitOptions options)
    : model_(model),
      mapped_(mapped),
      times_(std::move(times)),
      options_(std::move(options)),
      outline_(options_.solver == FitOptions::Solver::joint && mapped.outline.cols() > 0),
      fitter_(model, mapped.vertices,
              outline_ ? LandmarkFitter::Outline::given : LandmarkFitter::Outline::none) {}

std::vector<FrameFit> ClipFit::all(const Context& context) const {
  return of(frames_between(0, static_cast<int>(mapped_.points.rows())), context);
}

std::vector<FrameFit> ClipFit::of(const std::vector<int>& frames, const Context& context) const {
  return fitter_.fit(mapped_.points(frames, Eigen::all), options_, times_(frames),
                     outline_ ? Frames(mapped_.outline(frames, Eigen::all)) : Frames(), context);
}

ClipPeople people_in(const ClipFit& clip, const FittedCoefficients& fit, const Context& context) {
  ClipPeople people;
  const bool one_shape = clip.shape() == FitOptions::Shape::clip;
  if (!one_shape || clip.model().identities().size() == 0) return people;
  people.halves = halves_distance(clip, fit, context.part(0, 0.5));
  people.places = places_distance(clip, frames_of_places(clip.mapped(), fit, people.cuts),
                                  context.part(0.5, 1));
  return people;
}

}  // namespace mimetra
