#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// What share of the motion each vertex of a mesh takes, as someone painted it.
struct Painting {
  /// N, each in [0, 1], one of them above 0.
  Eigen::VectorXd weights;
  /// What the user should know of how it was read.
  std::vector<std::string> notes = {};
};

/// Reads a painting of a mesh:
///  - .png, .jpg: a picture in the mesh's texture space, black for 0 and white for 1, as
///    Brightness::at() gives it at the texture coordinates of each corner; a vertex has the mean of
///    its corners, and 0 where none of them has texture coordinates;
///  - .txt: a number for each vertex, in their order;
///  - .csv: the columns vertex,weight (0-based, once each at most); other vertices have 0.
///
/// Throws IoError, which begins with `mesh_name` for a texture coordinate that is not finite, and
/// what check_painting() throws; MismatchError for a picture where the mesh has no texture
/// coordinates, for another number of vertices, and a vertex it does not have.
Painting read_painting(const std::filesystem::path& path, const Connectivity& mesh,
                       const std::string& mesh_name = "the mesh");

/// Throws IoError that begins with `name` unless all weights are in [0, 1] and one is above 0; it
/// names the first vertex of another, and the range that others seem to be in, such as percent.
void check_painting(const std::string& name, const Eigen::VectorXd& weights);

}  // namespace mimetra
