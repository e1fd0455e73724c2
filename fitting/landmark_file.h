#pragma once

#include <filesystem>
#include <string>

#include "toolkit/model/landmark_track.h"

namespace mimetra {

/// Reads landmarks by the file's extension. Throws IoError that names line, or element of a JSON
/// file, and what was expected there.
///
/// - `.pts`: one frame, `version: 1`, `n_points: 68` and the points in braces, 1-based, which
/// become
///   0-based.
/// - `.csv`: a header and one row a frame: columns x0, y0, x1, ... (or OpenFace's x_0, ..., y_0,
///   ...), 0-based, and optionally `time` or `timestamp` (ascending), `confidence`, `success` (0:
///   nothing of the frame was seen); others are left out. x0 is the landmark "1". An empty field or
///   `nan` is a landmark not seen.
/// - `.json`: {"frames": [{"points": [[x, y], null, ...], "time": s, "confidence": c}, ...]} with
///   optional "names" beside "frames"; or one such frame alone. 0-based; null is not seen.
LandmarkTrack read_landmarks(const std::filesystem::path& path);

/// The text of a .csv file from which read_landmarks() reads the same numbers. Throws MismatchError
/// where landmarks have names other than "1", "2", ..., for which it has no place.
std::string landmark_csv(const LandmarkTrack& track);

}  // namespace mimetra
