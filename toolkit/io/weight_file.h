#pragma once

#include <filesystem>

#include "toolkit/io/weight_track.h"

namespace mimetra {

/// Reads weights. An ARKit / Live Link Face style CSV has a header of names and one row a frame;
/// columns `time` (seconds), `frame`, `Timecode` and `BlendShapeCount` are not weights. Without
/// times, numbers of frames tell how many lie between rows (WeightTrack::step). Timecodes
/// give times from 0 on, at the rate that their frames are counted by. A byte-order mark and CRLF
/// are accepted.
///
/// NAME.json holds rows of objects ([{"time": 0, "jawOpen": 0.5}], or these as "rows" or "frames"),
/// which may be MediaPipe's results ("faceBlendshapes" with "timestamp_ms"); or "names" and
/// "weights" (F x names) with "times" or "fps", by Audio2Face's keys too; or a list for each name,
/// as pandas writes tables; or is what `mimetra fit` wrote.
///
/// An empty or NaN weight of a CSV is missing: it lies between its neighbours'.
///
/// Throws IoError that names line and column for ragged rows (decimal commas between commas make
/// some), tabs between fields, what is not a finite number, times that do not ascend, duplicate
/// names, JSON in a CSV and the other way round. What is odd about the weights themselves is told
/// where the expressions are known: note_odd_weights().
WeightTrack read_weights(const std::filesystem::path& path);

/// Writes `time` and one column per name, the shortest digits that read back equal. Throws
/// OutputError; std::invalid_argument where names, times and weights differ in number.
void write_weights(const std::filesystem::path& path, const WeightTrack& track, bool overwrite);

}  // namespace mimetra
