#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Brightness of a picture's pixels, row by row from the top left: 0 is black, kWhite is white.
struct Brightness {
  static constexpr double kWhite = 65535;

  /// height x width.
  Eigen::Matrix<std::uint16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> pixels;
  /// Notes for the user on how colour and transparency were used.
  std::vector<std::string> notes = {};

  /// Brightness in [0, 1] at a place of the texture, u to the right and v up, both from 0 to 1 at
  /// the picture's edges. It is linear between the centres of the four pixels around the place, and
  /// constant from the outer centres to the edges. If is_beyond(), the picture repeats.
  /// \pre the picture has pixels; u and v are finite
  double at(double u, double v) const;

  /// Coordinates this far beyond 0 and 1 are rounding errors and count as 0 and 1.
  static constexpr double kRounding = 1e-4;
  /// True if the picture repeats at this place. \pre u and v are finite
  static bool is_beyond(double u, double v);
};

/// Reads a PNG or JPEG file, whatever its extension, with up to 16 bits a channel. Brightness is
/// the luma, 0.299 R + 0.587 G + 0.114 B of the file's values, times the opacity, as over black. If
/// all pixels have one colour and only the opacity differs, brightness is the opacity. Exif data
/// are ignored, as in a texture. Throws IoError for a file that is truncated, damaged, or of
/// another type.
Brightness read_brightness(const std::filesystem::path& path);

/// Share of the motion that each vertex of a mesh takes, as painted by a user.
struct Painting {
  /// Weights (N) in [0, 1], at least one of them above 0.
  Eigen::VectorXd weights;
  /// Notes for the user on how the painting was read.
  std::vector<std::string> notes = {};
};

/// Reads a painting of a mesh:
///  - .png, .jpg: a picture in the mesh's texture space, black for 0 and white for 1. A vertex gets
///    the mean of Brightness::at() over its corners, or 0 if none of them has texture coordinates.
///  - .txt: one number for each vertex, in their order.
///  - .csv: the columns vertex,weight (0-based, each vertex at most once); other vertices get 0.
///
/// Throws IoError, also for the errors of check_painting(). For a texture coordinate that is not
/// finite its message begins with `mesh_name`. Throws MismatchError for a picture if the mesh has
/// no texture coordinates, for another number of vertices, and for a vertex that the mesh does not
/// have.
Painting read_painting(const std::filesystem::path& path, const Connectivity& mesh,
                       const std::string& mesh_name = "the mesh");

/// Throws IoError that begins with `name` unless all weights are in [0, 1] and one is above 0. The
/// message gives the first vertex out of range, and the likely unit, such as percent.
void check_painting(const std::string& name, const Eigen::VectorXd& weights);

}  // namespace mimetra
