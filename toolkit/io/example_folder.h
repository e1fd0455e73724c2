#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

struct ExampleShape {
  std::string name;  ///< file name without extension
  std::filesystem::path path;
  Positions pose;  ///< N x 3
};

/// Poses of one face and the known weights of some of them.
struct ExampleFolder {
  std::vector<ExampleShape> shapes;  ///< in natural order of their file names
  /// Weights from examples.csv, one row for each of `weighted`; no names without such a file.
  WeightTrack weights = {};
  std::vector<std::string> weighted = {};
};

/// Reads the meshes of a folder and the `examples.csv` in it. All meshes are poses of one face with
/// the connectivity `expected`, which messages call `expected_name`. The first column of
/// examples.csv, `mesh`, contains names of meshes; the others are expressions.
///
/// Throws IoError if the folder cannot be read, contains no mesh or contains two of one name. Also
/// throws it if a row or a column of examples.csv occurs twice, or a row's mesh is missing. Throws
/// MismatchError if a mesh has other faces.
ExampleFolder read_examples(const std::filesystem::path& folder, const Connectivity& expected,
                            const std::string& expected_name);

}  // namespace mimetra
