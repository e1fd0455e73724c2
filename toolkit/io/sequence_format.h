#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/io/mesh_formats.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/option.h"

/// Arguments and results of opening and writing sequences, and the table of formats.
namespace mimetra {

class PendingOutputs;

/// Settings for opening a sequence that its name does not contain.
struct SequenceSource {
  /// Blendshape weights that drive a model.
  std::optional<std::filesystem::path> weights = {};
  /// Mesh file with the faces for a file that stores none.
  std::optional<std::filesystem::path> topology = {};
  /// Selection `A:B:STEP` of the frames, 0-based, without B; each part may be left out.
  std::optional<std::string> frames = {};
  /// Frames per second if the files contain no times.
  std::optional<double> fps = {};
  /// Factor for the weights; without it, weights far beyond 0 to 1 are refused.
  std::optional<double> weight_scale = {};

  static constexpr Option kWeights{"weights", &SequenceSource::weights};
  static constexpr Option kTopology{"topology", &SequenceSource::topology};
  static constexpr Option kFrames{"frames", &SequenceSource::frames};
  static constexpr Option kFps{
      "fps", &SequenceSource::fps, {.minimum = 1e-3, .maximum = 1e6}, "frames per second"};
  static constexpr Option kWeightScale{
      "weight_scale", &SequenceSource::weight_scale, {.minimum = 1e-6, .maximum = 1e6}, "a factor"};
  static constexpr auto declared() { return std::tuple(kFps, kWeightScale); }
};

/// Throws std::invalid_argument if `source` has a frame rate although the frames of `name` have
/// times (F).
void check_rate(const std::string& name, const Eigen::VectorXd& times,
                const SequenceSource& source);

/// Throws IoError with `name` and the first frame whose time is not finite or not later than the
/// one before.
void check_times(const std::string& name, const Eigen::VectorXd& times);

/// Note on times (F) that are probably not in seconds: their median step exceeds a second, or ten
/// or more frames are at whole seconds, at least one apart. "" if there is nothing to note.
std::string note_on_steps(const Eigen::VectorXd& times);

/// Sequence whose poses are read when needed, and notes from opening it.
struct OpenSequence {
  std::shared_ptr<const FrameSource> frames;
  /// True if the rest pose is a model's neutral, whether or not weights drive the model.
  bool model_driven = false;
  /// Files that it is read from, in order.
  std::vector<std::filesystem::path> files = {};
  /// Notes, for example on weight names that match no expression.
  std::vector<std::string> notes = {};
};

struct SequenceWriteOptions {
  /// Format of the frames in a folder.
  MeshFormat format = MeshFormat::ply;
  /// `double_precision` applies to mesh files; poses far from the origin always have it.
  /// `single_precision` applies to arrays.
  bool double_precision = false;
  bool single_precision = false;
  /// Fields to write on the mesh, if SequenceFormat::fields can read them back.
  std::vector<Field> fields = {};
  bool overwrite = false;
  /// Files and folders that were read and must not be replaced.
  std::vector<std::filesystem::path> inputs = {};
  /// Outputs that must appear together with this one; null for none.
  PendingOutputs* together = nullptr;

  static constexpr Option kFormat{"format", &SequenceWriteOptions::format};
  static constexpr Option kDoublePrecision{"double_precision",
                                           &SequenceWriteOptions::double_precision};
  static constexpr Option kSinglePrecision{"single_precision",
                                           &SequenceWriteOptions::single_precision};
  static constexpr Option kOverwrite{"overwrite", &SequenceWriteOptions::overwrite};
  static constexpr auto declared() {
    return std::tuple(kFormat, kDoublePrecision, kSinglePrecision, kOverwrite);
  }
};

/// Further files (name, content) that appear together with an output, in its folder or beside its
/// file.
using ExtraFiles = std::vector<std::pair<std::string, std::string>>;

class Animation;

/// Format of files that store a sequence. Readers, writers, and all lists of formats use this
/// declaration.
struct SequenceFormat {
  /// Name, such as "PC2 point cache".
  std::string name;
  /// Extensions in lower case, such as ".pc2".
  std::vector<std::string> extensions;
  /// True if faces and rest pose may be in files beside it.
  bool has_companions = false;
  /// Default precision of positions, and the alternative that an option selects.
  enum class Precision { single, single_or_double, double_or_single };
  Precision precision;
  OpenSequence (*open)(const std::filesystem::path&, const SequenceSource&, const Context&);
  std::unique_ptr<FrameSink> (*begin)(const SequenceHeader&, const std::filesystem::path& target,
                                      const SequenceWriteOptions&, const ExtraFiles&,
                                      const Context&);
  /// Parts that its files, and files beside them, can store. Commands report the parts that are
  /// lost.
  HeldParts holds = {};
  /// Writes a model and its weights; null if the format stores poses only.
  std::vector<std::filesystem::path> (*write_animation)(const Animation&,
                                                        const std::filesystem::path& target,
                                                        const SequenceWriteOptions&,
                                                        const ExtraFiles&,
                                                        const Context&) = nullptr;
  /// Reads the fields on its mesh; null for a format without fields.
  FieldsRead (*fields)(const std::filesystem::path&, const Connectivity&, const Context&) = nullptr;
};

/// All formats, in the order of lists for users.
const std::vector<SequenceFormat>& sequence_formats();
/// Format of a path by its extension, in any case; null if no format has it.
const SequenceFormat* sequence_format(const std::filesystem::path& path);
std::vector<std::string> sequence_extensions();

}  // namespace mimetra
