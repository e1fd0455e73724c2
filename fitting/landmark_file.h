#pragma once

#include <filesystem>
#include <string>

#include "toolkit/model/landmark_track.h"

namespace mimetra {

/// Reads landmarks in the format of the file's extension. Throws IoError with the line, or the
/// element of a JSON file, and what was expected there.
///
/// - `.pts`: one frame: `version: 1`, `n_points: 68` and the points in braces. The file counts
///   pixels from 1, the result counts from 0.
/// - `.csv`: a header and one row a frame. Columns are x0, y0, x1, ... or OpenFace's x_0, ..., y_0,
///   ..., numbered from 0 or 1, in pixels from 0. The first landmark gets the name "1". An empty
///   field or `nan` is a landmark that was not seen. Optional columns, in any case: a time
///   (ascending; the first column that time_columns.h knows, or OpenFace's `timestamp` in seconds),
///   `frame` (ascending numbers, used without a time), `confidence`, and `success` (0 if nothing
///   was seen). Other columns are ignored.
/// - `.json`: {"frames": [{"points": [[x, y], null, ...], "time": s, "confidence": c}, ...]}, or
///   a list of frames, or one frame. Pixels count from 0. A landmark that was not seen is null or
///   has null for x and y. Optional: "names" and "fps" beside "frames", "frame" in each frame, and
///   times under any name in time_columns.h. A frame may also hold results of MediaPipe's Face
///   Landmarker with "timestamp_ms": "faceLandmarks", "face_landmarks", "multi_face_landmarks" or
///   "landmark", each with faces of {"x", "y", "z"}. One face is followed (followed_face.h).
///
/// Coordinates are at most 1e7 pixels. Frame numbers that do not number every frame are ignored
/// with a note. Numbered landmarks of a track with 468 or 478 are MediaPipe's and get the names
/// "mp0" to "mp477".
LandmarkTrack read_landmarks(const std::filesystem::path& path);

/// Text of a .csv file from which read_landmarks() reads the same numbers. Throws MismatchError if
/// the landmarks have names other than the default ones, since the file only numbers them.
std::string landmark_csv(const LandmarkTrack& track);

}  // namespace mimetra
