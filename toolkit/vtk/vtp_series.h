#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/io/format.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/fields.h"

namespace mimetra {

/// Writes a sequence with its fields for ParaView: `NAME.pvd` and `NAME.vtp.series` beside a folder
/// `NAME_vtp` of `NAME_0000.vtp` ... For a target NAME.vtp, writes only the first frame, into one
/// file. Positions are float32, ids 32-bit, times in seconds, and all data compressed binary. The
/// user's polygons are kept; a triangle field gives each polygon the largest value of its
/// triangles.
///
/// The write is atomic: the .pvd appears last. Returns the files written, beginning with `target`.
/// Throws OutputError if a file cannot be written, and MismatchError for values beyond single
/// precision. Throws std::invalid_argument if a field's size does not match the mesh, two fields
/// share a name, or the target is neither .pvd nor .vtp.
std::vector<std::filesystem::path> write_vtp_series(const FieldSequence& fields,
                                                    const std::filesystem::path& target,
                                                    const WriteOptions& = {},
                                                    const Context& context = {});

/// Opens a series as write_vtp_series() or ParaView writes it: NAME.pvd, NAME.vtp.series, a folder
/// or pattern of numbered files, or one file. Files are .vtp, .vtu or legacy .vtk.
///
/// Keeps the fields that are equal in all chosen frames, and reads each frame once to compare them.
/// Notes name the dropped fields, but may omit fields that are missing from the first frame. If
/// DisplacedRest finds a rest pose, `displacement` gives that pose and is not a field.
///
/// The other frames are read when they are needed, with the same errors. Throws IoError, which
/// names the file, and Cancelled. Throws MismatchError if a frame has other vertices or faces.
/// Faces may be in another order or triangulated differently, but not flipped.
FieldSequence open_vtp_series(const std::filesystem::path& path, const ReadOptions& = {},
                              const Context& context = {});

/// Reads a series like open_vtp_series(), with all frames in memory.
FieldSequence read_vtp_series(const std::filesystem::path& path, const ReadOptions& = {},
                              const Context& context = {});

/// Files that open_vtp_series() reads for a path: the list or the file, and all frames.
std::vector<std::filesystem::path> vtp_series_files(const std::filesystem::path& path);

/// Field on the vertices of a .vtp file (N x c). Throws IoError if the file or field is missing.
Eigen::MatrixXd read_vtp_field(const std::filesystem::path& path, const std::string& name);

/// Field on the vertices of a .vtp file (N x c), or nothing if the field is missing.
std::optional<Eigen::MatrixXd> find_vtp_field(const std::filesystem::path& path,
                                              const std::string& name);

}  // namespace mimetra
