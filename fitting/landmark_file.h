#pragma once

#include <filesystem>
#include <string>

#include "toolkit/model/landmark_track.h"

namespace mimetra {

/// Reads landmarks by the file's extension. Throws IoError that names line, or element of a JSON
/// file, and what was expected there.
///
/// - `.pts`: one frame, `version: 1`, `n_points: 68` and the points in braces, 1-based, which
///   become 0-based.
/// - `.csv`: a header and one row a frame: columns x0, y0, x1, ... (or OpenFace's x_0, ..., y_0,
///   ...; counted from 0 or from 1), 0-based pixels, and optionally, in any case, a time
///   (ascending; the first column that time_columns.h knows, or OpenFace's `timestamp` in seconds)
///   or `frame` (ascending numbers), `confidence`, `success` (0: nothing of the frame was seen);
///   others are left out. The first landmark is "1". An empty field or `nan` is a landmark not
///   seen.
/// - `.json`: {"frames": [{"points": [[x, y], null, ...], "time": s, "confidence": c}, ...]} with
///   optional "names" and "fps" beside "frames", and "frame" in each, and times by any name in
///   time_columns.h; or a list of frames, or one frame alone. 0-based; null, also for x and y, is
///   not seen. In a frame also the results of MediaPipe's Face Landmarker ("faceLandmarks",
///   "face_landmarks", "multi_face_landmarks", "landmark": faces of {"x", "y", "z"}), of whose
///   faces one is followed (followed_face.h), with "timestamp_ms".
///
/// No landmark is more than 1e7 pixels from the corner. Numbers of frames that do not number every
/// frame are left out, with a note.
///
/// 468 or 478 numbered landmarks are MediaPipe's, "mp0" to "mp477".
LandmarkTrack read_landmarks(const std::filesystem::path& path);

/// The text of a .csv file from which read_landmarks() reads the same numbers. Throws MismatchError
/// where landmarks have names of their own, for which it has no place.
std::string landmark_csv(const LandmarkTrack& track);

}  // namespace mimetra
