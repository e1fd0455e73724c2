#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// How bright the pixels of a picture are, row after row from the top left: 0 is black, kWhite
/// white.
struct Brightness {
  static constexpr double kWhite = 65535;

  /// height x width.
  Eigen::Matrix<std::uint16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> pixels;
  /// What the user should know: which of colour and transparency was looked at.
  std::vector<std::string> notes = {};

  /// In [0, 1] at a place of the texture, u to the right and v up, both 0 and 1 at the picture's
  /// edges: linear between the centres of the four pixels around it, of which there are none beyond
  /// the edges. Where is_beyond() the picture is repeated. \pre it has pixels, u and v are finite
  double at(double u, double v) const;

  /// So far beyond 0 and 1 lie coordinates that are meant to be there, but for rounding; they count
  /// as 0 and 1.
  static constexpr double kRounding = 1e-4;
  /// True where the picture is repeated. \pre u and v are finite
  static bool is_beyond(double u, double v);
};

/// Reads a PNG or JPEG file, whatever its extension; 8 bits a channel or fewer are as exact as 16.
/// Of colours it is the luma, 0.299 R + 0.587 G + 0.114 B of the values in the file, times their
/// opacity, as if they lay on black; where all pixels have one colour and only their opacity
/// differs, it is the opacity alone. What Exif data say about the camera is not looked at, as in a
/// texture. Throws IoError for a file that is truncated, damaged, or of another type.
Brightness read_brightness(const std::filesystem::path& path);

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
