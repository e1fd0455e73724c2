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

/// What opening a sequence is given and gives, what writing one is given, and the table of formats.
namespace mimetra {

class PendingOutputs;

/// What a sequence's name does not say.
struct SequenceSource {
  /// Blendshape weights that drive a model.
  std::optional<std::filesystem::path> weights = {};
  /// Mesh file with the faces of a file that holds none.
  std::optional<std::filesystem::path> topology = {};
  /// Part `A:B:STEP` of the frames, 0-based, B excluded; each may be left out.
  std::optional<std::string> frames = {};
  /// Frames per second where the files say nothing of time.
  std::optional<double> fps = {};
  /// Factor of the weights; without one, those far beyond 0 to 1 are refused.
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

/// Throws std::invalid_argument where `source` has a frame rate for `name`, whose frames have times
/// of their own (F).
void check_rate(const std::string& name, const Eigen::VectorXd& times,
                const SequenceSource& source);

/// Throws IoError that names `name` and the first frame whose time is not finite, or not later than
/// the one before.
void check_times(const std::string& name, const Eigen::VectorXd& times);

/// What is odd about times (F) whose frames are more than a second apart, by the median, or ten and
/// more a second apart at whole seconds; "" for nothing.
std::string note_on_steps(const Eigen::VectorXd& times);

/// A sequence whose poses are read when they are needed, and what was noticed while opening it.
struct OpenSequence {
  std::shared_ptr<const FrameSource> frames;
  /// True for a model, with or without weights: its rest pose is its neutral.
  bool model_driven = false;
  /// Files it comes from, in order.
  std::vector<std::filesystem::path> files = {};
  /// Which weight names were not matched, and the like.
  std::vector<std::string> notes = {};
};

struct SequenceWriteOptions {
  /// Of the frames in a folder.
  MeshFormat format = MeshFormat::ply;
  /// Double precision in mesh files, which poses far from the origin have in any case; single
  /// precision in arrays.
  bool double_precision = false;
  bool single_precision = false;
  /// Written on the mesh where SequenceFormat::fields reads them back.
  std::vector<Field> fields = {};
  bool overwrite = false;
  /// Files and folders that were read, which must stay.
  std::vector<std::filesystem::path> inputs = {};
  /// Outputs that it appears together with; alone without.
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

/// Further files (name, content) that appear together with an output: in its folder, or beside its
/// file.
using ExtraFiles = std::vector<std::pair<std::string, std::string>>;

class Animation;

/// A format of files that hold a sequence, declared once: readers, writers, and every list of
/// formats come from it.
struct SequenceFormat {
  /// "PC2 point cache".
  std::string name;
  /// In lower case, such as ".pc2".
  std::vector<std::string> extensions;
  /// True where faces and rest pose stand in files beside it.
  bool has_companions = false;
  /// What positions are written in, and what they may be written in by option.
  enum class Precision { single, single_or_double, double_or_single };
  Precision precision;
  OpenSequence (*open)(const std::filesystem::path&, const SequenceSource&, const Context&);
  std::unique_ptr<FrameSink> (*begin)(const SequenceHeader&, const std::filesystem::path& target,
                                      const SequenceWriteOptions&, const ExtraFiles&,
                                      const Context&);
  /// What its files and those beside them have a place for: what they have none for is said.
  HeldParts holds = {};
  /// Writes a model and its weights as such; null where only poses are written.
  std::vector<std::filesystem::path> (*write_animation)(const Animation&,
                                                        const std::filesystem::path& target,
                                                        const SequenceWriteOptions&,
                                                        const ExtraFiles&,
                                                        const Context&) = nullptr;
  /// The fields on its mesh; null for a format that has no place for any.
  FieldsRead (*fields)(const std::filesystem::path&, const Connectivity&, const Context&) = nullptr;
};

/// All formats, in the order in which lists have them.
const std::vector<SequenceFormat>& sequence_formats();
/// The format of a path by its extension, in any case; null for one that is none of theirs.
const SequenceFormat* sequence_format(const std::filesystem::path& path);
/// The extensions of all formats.
std::vector<std::string> sequence_extensions();

}  // namespace mimetra
