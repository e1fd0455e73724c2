#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "toolkit/regions/regions.h"

namespace mimetra {

/// Reads a region set for a mesh of `vertices` vertices:
///  - .json: {"regions": [{"vertices": [..]}]}, or a list of vertex lists. If the border is soft,
///    "weights" has a weight for every vertex.
///  - .csv: The columns are vertex,region.
///  - .txt: One 0-based vertex index a line, or a mask of N zeros and ones.
///  - .om: Its properties, as in region_of_mask().
///
/// Throws IoError, also for weights that check_painting() refuses. Throws MismatchError for an
/// index outside the mesh, and for data of a mesh with another number of vertices.
Regions read_regions(const std::filesystem::path& path, int vertices, const Triangles& triangles);

/// Region from vertex fields in the file `name`: the vertices with `roi` (N x 1) other than 0, with
/// the `weight` (N x 1) of a soft border. Throws as read_regions(), and MismatchError for another
/// number of columns.
Regions region_of_mask(const std::string& name, const Eigen::MatrixXd& roi,
                       const std::optional<Eigen::MatrixXd>& weight, int vertices,
                       const Triangles& triangles);

/// Content of a .json file and of a .csv file (vertex,region). The JSON has each region's centre,
/// radius and energies, the mesh's number of vertices, the shares of the whole, and the weights of
/// a soft border.
std::string regions_json(const Regions& regions);
std::string regions_csv(const Regions& regions);

}  // namespace mimetra
