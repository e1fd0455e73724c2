#pragma once

#include <filesystem>

#include "toolkit/io/weight_track.h"

namespace mimetra {

/// Reads weights from .csv or .json.
///
/// A CSV, as from ARKit or Live Link Face, has a header of names and one row a frame. Columns
/// `time` (seconds), `frame`, `Timecode` and `BlendShapeCount` are not weights. Without times,
/// frame numbers give the distance of rows (WeightTrack::step). Timecodes give times from 0 on, at
/// the rate of their frame counts. A byte-order mark and CRLF are accepted. An empty or NaN weight
/// is missing and is interpolated from its neighbours.
///
/// A JSON file has one of these forms:
///  - Rows of objects ([{"time": 0, "jawOpen": 0.5}]), also as "rows" or "frames". They may be
///    MediaPipe's results ("faceBlendshapes" with "timestamp_ms").
///  - "names" and "weights" (F x names) with "times" or "fps", or Audio2Face's keys for these.
///  - A list for each name, as pandas writes tables.
///  - The output of `mimetra fit`.
///
/// Throws IoError with line and column, or with the place in JSON. Errors are ragged rows (also
/// from decimal commas between commas), tabs between fields, and numbers that are not finite.
/// Others are times that do not ascend, duplicate names, JSON in a CSV, and CSV in a .json file.
WeightTrack read_weights(const std::filesystem::path& path);

/// Writes `time`, if the track has times, and one column per name, with the shortest digits that
/// read back equal. Throws OutputError, and std::invalid_argument if names, times and weights
/// differ in number.
void write_weights(const std::filesystem::path& path, const WeightTrack& track, bool overwrite);

}  // namespace mimetra
