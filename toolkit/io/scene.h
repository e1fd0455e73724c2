#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"

/// Files of a whole scene, glTF: meshes with morph targets and their weights over
/// time. Internal to their formats.
namespace mimetra {

/// Weights of the targets of one part over time: keys, and what lies between them.
struct WeightCurve {
  enum class Between { step, linear, cubic };

  Between between = Between::linear;
  Eigen::VectorXd times;   ///< of the keys (K), rising
  Eigen::MatrixXd values;  ///< K x targets; one row without times for weights that stay
  /// Slopes before and after each key, K x targets, of cubic curves.
  Eigen::MatrixXd slopes_in, slopes_out;

  /// The weights at a time; those of the nearest key outside of the keys. \pre there is a row
  Eigen::RowVectorXd at(double time) const;
  /// Whether they are the same at all times. \pre there is a row
  bool is_still() const;
};

/// Displacements of a part that one weight drives.
struct SceneTarget {
  std::string name;
  Positions displacements;  ///< N x 3
  /// The mesh of the file that has a number for it and no name.
  std::optional<std::size_t> unnamed_in = {};
};

/// One mesh of a scene, where the scene puts it.
struct ScenePart {
  std::string name;
  Positions positions;  ///< N x 3
  Polygons polygons;
  TextureCoordinates texture;
  /// Names of materials, each from its first polygon on.
  std::vector<FaceGroup> groups;
  std::vector<SceneTarget> targets;
  /// A column for each target, or more; null for weights of 0.
  std::shared_ptr<const WeightCurve> weights = {};
};

/// A face and what it performs.
struct Scene {
  std::shared_ptr<const BlendshapeModel> model;
  /// The same model, with an expression of its own for each course of weights.
  std::shared_ptr<const BlendshapeModel> performer = {};
  /// Weights of its expressions (F x D) and their seconds (F); no frames where nothing is driven.
  Eigen::MatrixXd weights = {};
  Eigen::VectorXd times = {};
  /// False where the model's neutral only stands in for a rest pose that nobody knows.
  bool rest_is_known = true;
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
  /// What was left out of its movement: of no interest for its shapes.
  std::vector<std::string> motion_notes = {};
  /// What its shapes are without the file's own weights: of no interest for its movement.
  std::vector<std::string> model_notes = {};
};

/// Throws IoError where `vertices` in `poses` poses would take far more memory than a file of
/// `file_bytes` can mean.
void check_scene_size(const std::string& path, double vertices, double poses,
                      std::size_t file_bytes);

/// One model of all parts, one after the other. Targets of equal names are one expression of the
/// model, and of the performer where their weights are equal at all times; two of one name in one
/// part are two. Frames are at the keys of all curves. Throws IoError where there is no part,
/// a face has a bad index, a key's time does not rise, or all of them would take more memory than a
/// file of `file_bytes` can mean.
Scene joined_scene(const std::string& path, std::vector<ScenePart> parts, std::size_t file_bytes);

/// True for the extension of a scene's file, also one that is only refused by what it is.
bool is_scene_file(const std::filesystem::path& path);

/// Reads a scene. Throws IoError, Cancelled.
Scene read_gltf(const std::filesystem::path& path, const Context& context = {});

}  // namespace mimetra
