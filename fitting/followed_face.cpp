#include "fitting/followed_face.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

namespace mimetra {

namespace {

using Faces = std::vector<FaceBox>;

/// Distance from the middle of one face to another, in sizes of the first.
double distance(const FaceBox& from, const FaceBox& to) {
  constexpr double kThinnest = 0.3;  // thinner boxes hold a part of a face
  const Eigen::Array2d size = from.size.max(kThinnest * from.size.maxCoeff());
  return ((to.middle - from.middle) / size).matrix().norm();
}

/// Face last seen at a place, and the number of its frame among the frames with faces.
struct Place {
  FaceBox face;
  int frame;
};

/// Assigns known places or new ones to the faces of a frame.
std::vector<int> places_of(const Faces& faces, int frame, std::vector<Place>& known) {
  // A detector may find a face twice; boxes that overlap this much are one face.
  constexpr double kOnAnother = 0.5;
  std::vector<std::tuple<bool, double, int, int>> pairs;  // was left, distance, place, face
  for (std::size_t place = 0; place < known.size(); ++place) {
    for (std::size_t face = 0; face < faces.size(); ++face) {
      const double apart = distance(known[place].face, faces[face]);
      const bool was_left = known[place].frame < frame - 1;
      if (apart <= 1) pairs.emplace_back(was_left, apart, int(place), int(face));
    }
  }
  std::ranges::sort(pairs);
  std::vector<int> places(faces.size(), -1);
  for (const auto& [was_left, apart, place, face] : pairs) {
    int& own = places[static_cast<std::size_t>(face)];
    if (own < 0 && std::ranges::find(places, place) == places.end()) own = place;
  }
  for (std::size_t face = 0; face < faces.size(); ++face) {
    const auto lies_on = [&](std::size_t other) {
      return places[other] >= 0 && distance(faces[other], faces[face]) < kOnAnother;
    };
    for (std::size_t other = 0; other < faces.size() && places[face] < 0; ++other) {
      if (lies_on(other)) places[face] = places[other];
    }
    if (places[face] < 0) {
      places[face] = static_cast<int>(known.size());
      known.emplace_back();
    }
  }
  for (std::size_t face = faces.size(); face-- > 0;) {  // keeps the first of two on each other
    known[static_cast<std::size_t>(places[face])] = {faces[face], frame};
  }
  return places;
}

/// Pairs of places with faces in one frame, in both orders.
std::set<std::pair<int, int>> places_together(const std::vector<std::vector<int>>& places) {
  std::set<std::pair<int, int>> together;
  for (const std::vector<int>& own : places) {
    for (const int a : own) {
      for (const int b : own) {
        if (a != b) together.emplace(a, b);
      }
    }
  }
  return together;
}

}  // namespace

FaceBox box_around(const ImagePoints& points) {
  Eigen::Array2d lowest = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d highest = -lowest;
  for (const auto& row : points.rowwise()) {
    if (row.hasNaN()) continue;
    const Eigen::Array2d point = row.transpose();
    lowest = lowest.min(point);
    highest = highest.max(point);
  }
  return {(lowest + highest) / 2, highest - lowest};
}

std::vector<std::vector<int>> face_places(const std::vector<Faces>& frames) {
  std::vector<Place> known;
  std::vector<std::vector<int>> places;
  int with_faces = 0;
  for (const Faces& faces : frames) {
    if (!faces.empty()) ++with_faces;
    places.push_back(places_of(faces, with_faces, known));
  }
  return places;
}

FollowedFace followed_face(const std::vector<Faces>& frames) {
  if (std::ranges::all_of(frames, [](const Faces& faces) { return faces.size() <= 1; })) {
    FollowedFace only;
    for (const Faces& faces : frames) only.chosen.push_back(faces.empty() ? -1 : 0);
    return only;
  }
  const std::vector<std::vector<int>> places = face_places(frames);
  const std::set<std::pair<int, int>> together = places_together(places);
  std::set<int> person;  // places of the followed person
  const auto is_person = [&](int place) { return person.contains(place); };
  const auto is_another = [&](int place) {
    return std::ranges::any_of(person, [&](int own) { return together.contains({own, place}); });
  };
  FollowedFace result;
  FaceBox last;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Faces& faces = frames[f];
    const std::vector<int>& own = places[f];
    int chosen = -1;
    // A face at a known place comes before others, then the nearest face.
    const auto merit = [&](std::size_t face) {
      return person.empty() ? std::pair(false, faces[face].size.matrix().norm())
                            : std::pair(is_person(own[face]), -distance(last, faces[face]));
    };
    for (std::size_t face = 0; face < faces.size(); ++face) {
      if (!is_person(own[face]) && is_another(own[face])) continue;
      if (chosen < 0 || merit(face) > merit(std::size_t(chosen))) chosen = int(face);
    }
    result.chosen.push_back(chosen);
    if (chosen < 0) continue;
    const auto place = own[static_cast<std::size_t>(chosen)];
    if (!person.empty() && !is_person(place)) result.jumps.push_back(static_cast<int>(f));
    person.insert(place);
    last = faces[static_cast<std::size_t>(chosen)];
  }
  return result;
}

}  // namespace mimetra
