#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "toolkit/regions/regions.h"

namespace mimetra {

/// Reads a region set for a mesh of `vertices`: .json ({"regions": [{"vertices": [..]}]}, with
/// "weights" of all vertices where the border is soft, or a list of vertex lists), .csv (columns
/// vertex,region), .txt (one vertex index a line, 0-based, or a mask of N zeros and ones) or .om
/// (its properties, as region_of_mask() takes them). Throws IoError; MismatchError for an index
/// outside the mesh, or for regions, weights or a mask of a mesh with another number of vertices;
/// of weights what check_painting() throws.
Regions read_regions(const std::filesystem::path& path, int vertices, const Triangles& triangles);

/// One region, of the fields on the vertices of a mesh in the file `name`: the vertices where `roi`
/// (N x 1) is not 0, with the `weight` (N x 1) of a soft border. Throws as read_regions, and
/// MismatchError for another number of columns.
Regions region_of_mask(const std::string& name, const Eigen::MatrixXd& roi,
                       const std::optional<Eigen::MatrixXd>& weight, int vertices,
                       const Triangles& triangles);

/// The content of a .json file (each region with its centre, radius and energies, the number of
/// vertices of the mesh, the shares of the whole, the weights of a soft border) and of a .csv file
/// (vertex,region).
std::string regions_json(const Regions& regions);
std::string regions_csv(const Regions& regions);

}  // namespace mimetra
