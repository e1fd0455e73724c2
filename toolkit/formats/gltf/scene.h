#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/blendshape_model.h"

/// Scene files (glTF): meshes with morph targets and their weights over time. Internal to their
/// formats.
namespace mimetra {

/// Weights of one part's targets over time: keys and the interpolation between them.
struct WeightCurve {
  enum class Between { step, linear, cubic };

  Between between = Between::linear;
  Eigen::VectorXd times;   ///< times of the keys (K), ascending
  Eigen::MatrixXd values;  ///< K x targets; constant weights are one row without times
  /// Slopes before and after each key of cubic curves, K x targets.
  Eigen::MatrixXd slopes_in, slopes_out;

  /// Weights at a time; outside the keys, the nearest key's. \pre there is a row
  Eigen::RowVectorXd at(double time) const;
  /// Whether the weights are the same at all times. \pre there is a row
  bool is_still() const;
};

/// Displacements of a part, driven by one weight.
struct SceneTarget {
  std::string name;
  Positions displacements;  ///< N x 3
  /// Mesh of the file in which this target has a number but no name.
  std::optional<std::size_t> unnamed_in = {};
};

/// Mesh of a scene, transformed to its place.
struct ScenePart {
  std::string name;
  Positions positions;  ///< N x 3
  Polygons polygons;
  TextureCoordinates texture;
  /// Material names, each applying from a polygon on.
  std::vector<FaceGroup> groups;
  std::vector<SceneTarget> targets;
  /// Curve with at least one column for each target; null for weights of 0.
  std::shared_ptr<const WeightCurve> weights = {};
};

/// Model of a face and its performance.
struct Scene {
  std::shared_ptr<const BlendshapeModel> model;
  /// Model with a separate expression for each course of weights.
  std::shared_ptr<const BlendshapeModel> performer = {};
  /// Weights of the performer's expressions (F x D), and seconds (F). No frames if nothing is
  /// driven.
  Eigen::MatrixXd weights = {};
  Eigen::VectorXd times = {};
  /// False if the rest pose is unknown and the model's neutral only stands in for it.
  bool rest_is_known = true;
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
  /// Notes on movement that was left out. They do not concern the shapes.
  std::vector<std::string> motion_notes = {};
  /// Notes on shapes without the file's own weights. They do not concern the movement.
  std::vector<std::string> model_notes = {};
};

/// Throws IoError if `vertices` in `poses` poses need far more memory than a file of `file_bytes`
/// justifies.
void check_scene_size(const std::string& path, double vertices, double poses,
                      std::size_t file_bytes);

/// Joins all parts into one model, in order. Targets with equal names become one expression of the
/// model. They are one expression of the performer only if their weights are equal at all times.
/// Two targets with one name in one part stay two. Frames are at the keys of all curves; jumps and
/// cubic curves add frames.
///
/// Throws IoError if there is no part, a face has a bad index, a position is not usable, key times
/// do not rise, a cubic curve lasts too long, or the result would need more memory than a file of
/// `file_bytes` justifies.
Scene joined_scene(const std::string& path, std::vector<ScenePart> parts, std::size_t file_bytes);

/// True for a .glb, .gltf or .vrm path that is not a folder, even if reading refuses its content.
inline bool is_scene_file(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  std::error_code unreadable;
  return (extension == ".glb" || extension == ".gltf" || extension == ".vrm") &&
         !std::filesystem::is_directory(path, unreadable);
}

/// Reads a scene. Throws IoError, Cancelled.
Scene read_gltf(const std::filesystem::path& path, const Context& context = {});

}  // namespace mimetra
