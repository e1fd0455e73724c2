#include "fitting/mediapipe.h"

#include <array>
#include <charconv>

#include "fitting/landmark_formats.h"

namespace mimetra {

namespace {

/// Of iBUG's landmarks 1 to 68 in turn. The jaw's are spread evenly along the face's oval from the
/// height of the eyes to the chin; eyes, brows, nose and lips are where the two schemes name the
/// same places.
constexpr std::array<int, 68> kOfIbug = {
    127, 234, 93,  132, 58,  136, 150, 176, 152, 400, 379, 365, 288, 361, 323, 454, 356,  // jaw
    70,  63,  105, 66,  107,                                    // right brow
    336, 296, 334, 293, 300,                                    // left brow
    168, 197, 195, 4,                                           // bridge
    98,  97,  2,   326, 327,                                    // nostrils
    33,  160, 158, 133, 153, 144,                               // right eye
    362, 385, 387, 263, 373, 380,                               // left eye
    61,  40,  37,  0,   267, 270, 291, 321, 405, 17,  181, 91,  // outer lips
    78,  81,  13,  311, 308, 402, 14,  178,                     // inner lips
};

constexpr const char* kPrefix = "mp";

}  // namespace

void name_mediapipe_landmarks(LandmarkTrack& track) {
  if (track.landmarks() != 468 && track.landmarks() != 478) return;
  if (track.names != numbered_names(track.names.size())) return;
  for (int i = 0; i < track.landmarks(); ++i) {
    track.names[static_cast<std::size_t>(i)] = kPrefix + std::to_string(i);
  }
}

bool is_mediapipe(const LandmarkTrack& track) {
  return !track.names.empty() && track.names.front() == "mp0";
}

std::optional<std::string> mediapipe_name(std::string_view ibug) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(ibug.data(), ibug.data() + ibug.size(), number);
  const bool is_number = error == std::errc() && end == ibug.data() + ibug.size();
  if (!is_number || number < 1 || number > kOfIbug.size()) return {};
  return kPrefix + std::to_string(kOfIbug[number - 1]);
}

void scale_to_pixels(LandmarkTrack& track, int width, int height) {
  // 0 is the image's edge there, and the middle of the first pixel here.
  for (Eigen::Index column = 0; column < track.points.cols(); ++column) {
    const double size = column % 2 == 0 ? width : height;
    track.points.col(column) = track.points.col(column).array() * size - 0.5;
  }
}

}  // namespace mimetra
