#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// A mesh of a folder of examples.
struct ExampleShape {
  std::string name;  ///< its file's, without extension
  std::filesystem::path path;
  Positions pose;  ///< N x 3
};

/// Poses of one face, and what is known of their weights.
struct ExampleFolder {
  std::vector<ExampleShape> shapes;  ///< in natural order of their names
  /// Of examples.csv, a row for each of `weighted`; no names where there is none.
  WeightTrack weights = {};
  std::vector<std::string> weighted = {};
};

/// Reads the meshes of a folder, which are poses of the face that `expected` is the connectivity of
/// and `expected_name` the name of, and `examples.csv` in it, whose first column `mesh` names a
/// mesh and whose others are expressions.
///
/// Throws IoError for a folder that holds no mesh, two of one name, or cannot be read, and for rows
/// of examples.csv that name no mesh, or one twice; MismatchError for a mesh of other faces.
ExampleFolder read_examples(const std::filesystem::path& folder, const Connectivity& expected,
                            const std::string& expected_name);

}  // namespace mimetra
