#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "toolkit/io/data.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/parameter.h"

/// What a file format is, and how its files are read and written.
namespace mimetra {

class Animation;
class PendingOutputs;
struct MeshContent;
struct MeshFrame;

/// Settings for reading a file. A format uses those that its declaration names.
struct ReadOptions {
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
  /// Read the fields on the mesh of a sequence.
  bool fields = true;
  /// Keep a model's identities, instead of reading one person.
  bool identities = false;
  /// Mesh of a region set: number of vertices, and triangles.
  int vertices = 0;
  const Triangles* triangles = nullptr;
  /// Values of all parameters of the call, for formats with parameters of their own; null for the
  /// defaults.
  const Parameters* parameters = nullptr;

  static constexpr Option kWeights{"weights", &ReadOptions::weights};
  static constexpr Option kTopology{"topology", &ReadOptions::topology};
  static constexpr Option kFrames{"frames", &ReadOptions::frames};
  static constexpr Option kFps{
      "fps", &ReadOptions::fps, {.minimum = 1e-3, .maximum = 1e6}, "frames per second"};
  static constexpr Option kWeightScale{
      "weight_scale", &ReadOptions::weight_scale, {.minimum = 1e-6, .maximum = 1e6}, "a factor"};
  static constexpr auto declared() { return std::tuple(kFps, kWeightScale); }
};

/// Further files (name, content) that appear together with an output, in its folder or beside its
/// file.
using ExtraFiles = std::vector<std::pair<std::string, std::string>>;

/// Compression of VTK's files: LZ4, or the slower zlib.
enum class Compression { fast, small };

constexpr std::string_view choice_name(Compression value) {
  switch (value) {
    case Compression::fast:
      return "fast";
    case Compression::small:
      return "small";
  }
  return {};
}

/// Settings for writing a file. A format uses those that its declaration names.
struct WriteOptions {
  /// Format of the frames in a folder: the extension of a mesh format without its dot, in any case.
  std::string frame_format = "ply";
  /// `double_precision` applies to mesh files; poses far from the origin always have it.
  /// `single_precision` applies to arrays.
  bool double_precision = false;
  bool single_precision = false;
  Compression compression = Compression::fast;
  /// Fields to write on the mesh, if the format has them.
  std::vector<Field> fields = {};
  bool overwrite = false;
  /// Files and folders that were read and must not be replaced.
  std::vector<std::filesystem::path> inputs = {};
  /// Outputs that must appear together with this one; null for none.
  PendingOutputs* together = nullptr;
  ExtraFiles extra = {};
  /// Values of all parameters of the call, for formats with parameters of their own; null for the
  /// defaults.
  const Parameters* parameters = nullptr;

  static constexpr Option kDoublePrecision{"double_precision", &WriteOptions::double_precision};
  static constexpr Option kSinglePrecision{"single_precision", &WriteOptions::single_precision};
  static constexpr Option kCompression{"compression", &WriteOptions::compression};
  static constexpr Option kOverwrite{"overwrite", &WriteOptions::overwrite};
  static constexpr auto declared() {
    return std::tuple(kDoublePrecision, kSinglePrecision, kCompression, kOverwrite);
  }
};

/// Parts, besides poses and triangles, that a format can store. Files beside the main one
/// (NAME.rest.ply, NAME.topology.ply) count as part of it.
struct HeldParts {
  enum class Texture { none, vertices, corners };

  /// Faces with more than three corners.
  bool polygons = false;
  /// Texture coordinates: none, one per vertex, or one per corner of a face.
  Texture texture = Texture::none;
  /// Faces without texture coordinates in a mesh where other faces have them.
  bool bare_faces = true;
  /// Groups, and the material of each face.
  bool groups = false;
  /// A rest pose that is not a frame.
  bool rest = true;
  /// The order of vertices; otherwise the format renumbers them.
  bool vertex_order = true;
  /// Times of frames.
  bool times = true;
  /// Unevenly spaced times, in a place that other programs read.
  bool uneven_times = true;
  /// Times in double precision; otherwise they are rounded to single precision.
  bool exact_times = true;
  /// True if positions that single precision would round visibly are stored in double precision or
  /// refused; false if they are rounded.
  bool exact_positions = true;

  bool operator==(const HeldParts&) const = default;
};

/// Summary for lists of formats, such as "polygons, UVs, groups and materials, rest pose".
std::string description(const HeldParts& held);

/// Parts of a sequence that a format cannot store, such as "texture coordinates"; empty if it
/// stores all. Reads a frame only if the sequence has one frame and its rest pose cannot be stored.
std::vector<std::string> parts_left_out(const HeldParts& held, const FrameSource& sequence);

/// A value and the reader's notes.
struct ReadValue {
  NamedData value;
  /// All files that were read, for the manifest.
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
};

/// Sequence whose poses are read when needed, and notes from opening it.
struct OpenSequence {
  std::shared_ptr<const FrameSource> frames;
  /// True if the rest pose is a model's neutral, whether or not weights drive the model.
  bool model_driven = false;
  /// Files that it is read from, in order.
  std::vector<std::filesystem::path> files = {};
  /// Notes, for example on weight names that match no expression.
  std::vector<std::string> notes = {};
  /// Fields on the mesh, if they were asked for.
  std::vector<Field> fields = {};
};

/// Reads x y z of each vertex of a further file of one mesh into `coordinates`, and compares the
/// bytes around the positions with the first file's. Returns false, with unspecified `coordinates`,
/// if bytes differ that affect faces, if a position is malformed or not finite, or if only the
/// format's full reader can parse the file.
using FurtherReader = std::function<bool(std::string_view bytes, std::span<double> coordinates)>;

/// A way to read and write one kind of value, declared once. Readers, writers and every list of
/// formats use this declaration. All functions throw IoError or OutputError, MismatchError,
/// Cancelled.
struct Format {
  /// Texts other than files have no extension: a folder, a pattern, MODEL@identity=1.5.
  static constexpr auto kFolder = "";
  static constexpr auto kAnyFile = "*";

  using Paths = std::vector<std::filesystem::path>;

  std::string name;  ///< "PC2 point cache"
  DataKind kind = DataKind::sequence;
  /// Extensions in lower case, such as ".pc2"; or only kFolder, or only kAnyFile.
  std::vector<std::string> extensions;
  /// Parameters for reading: those of ReadOptions, and its own.
  std::vector<Parameter> reading = {};
  /// Reads a value; empty for formats that are only written, and for those with `open`.
  std::function<ReadValue(const std::string& text, const ReadOptions&, const Context&)> read = {};
  /// Files with a number in their name are frames of one sequence, also in a folder.
  bool numbered = false;
  /// Parameters for writing: those of WriteOptions, and its own.
  std::vector<Parameter> writing = {};
  /// Writes a value atomically and returns the files; empty for formats that are only read, and for
  /// those with `create`.
  std::function<Paths(const Data&, const std::filesystem::path& target, const WriteOptions&,
                      const Context&)>
      write = {};
  /// A sequence keeps its fields.
  bool fields = false;
  /// Displacements from a rest pose replace fields of the same name: show_displacement().
  bool displacements = false;
  /// Other parts of a sequence that the files can store, with these options. If empty, losses are
  /// not reported.
  std::function<HeldParts(const WriteOptions&)> holds = {};
  /// The format stores blendshape weights, from a table or from a sequence that they drive. Only
  /// outputs with Output::weights use it.
  bool weights = false;
  /// Notes on what a value loses in this format. If empty, losses are not reported.
  std::function<std::vector<std::string>(const Data&, const std::filesystem::path&)> losses = {};

  /// Sequences frame by frame: `open` reads frames when needed, `create` begins a file.
  OpenSequence (*open)(const std::filesystem::path&, const ReadOptions&, const Context&) = nullptr;
  std::unique_ptr<FrameSink> (*create)(const SequenceHeader&, const std::filesystem::path& target,
                                       const WriteOptions&, const Context&) = nullptr;
  /// Writes a model and its weights; null if the format stores poses only.
  Paths (*create_animation)(const Animation&, const std::filesystem::path& target,
                            const WriteOptions&, const Context&) = nullptr;

  /// Files of one mesh, on bytes in memory. `parse_mesh` is null for STL, whose files do not index
  /// vertices. `further_reader` learns from a first file what files of the mesh share; it is null,
  /// or returns an empty function, if they share nothing. `mesh_frame` makes the bytes of files;
  /// only mesh formats have it.
  MeshContent (*parse_mesh)(const std::string& path, std::string_view bytes,
                            const Context&) = nullptr;
  FurtherReader (*further_reader)(std::string first, std::size_t vertices,
                                  const Context&) = nullptr;
  MeshFrame (*mesh_frame)(const Connectivity& connectivity, const std::vector<Field>& fields,
                          bool double_precision, const Context&) = nullptr;

  /// CMake's option that builds the format, such as "MIMETRA_GLTF"; empty if it is built.
  std::string built_by = {};

  bool has(const std::string& extension) const;
  /// Parameters for reading and writing, each once.
  std::vector<Parameter> options() const;
};

/// Throws UsageError, beginning with `text`, for a format that is not built into this program.
void require_built(const Format& format, const std::string& text);

/// List of extensions for messages and help: ".json, .csv or a folder".
std::string listed_extensions(std::vector<std::string> extensions);

/// Notes on everything that a format drops from a value. An example is "out.stl: this format
/// holds no texture coordinates or order of vertices; written without". Empty if the format stores
/// all.
std::vector<std::string> notes_on_losses(const Format& format, const Data& data,
                                         const std::filesystem::path& target,
                                         const WriteOptions& options);

/// Calls `write`, which makes the target and returns its files. The further files of the options
/// appear beside the target immediately afterwards. If either fails, no file appears. Returns all
/// files. Throws OutputError.
Format::Paths write_with_extra(const std::filesystem::path& target, const WriteOptions& options,
                               const std::function<Format::Paths()>& write);

/// Writes `text` to the target, and further files beside it. Returns all files. Throws OutputError.
Format::Paths write_text(const std::filesystem::path& target, const WriteOptions& options,
                         const std::string& text);

/// As write_text(), with the text of a document.
Format::Paths write_document(const Data& document, const std::filesystem::path& target,
                             const WriteOptions& options, const Context& context = {});

/// Mesh and fields on which regions are shown. Throws MismatchError, with the target's name, for
/// regions without a mesh.
const FieldSequence& shown_regions(const Data& regions, const std::filesystem::path& target);

/// Formats of one mesh in a file: OBJ, PLY, OFF, STL, OM.
const std::vector<Format>& mesh_formats();
/// Mesh format of an extension (".ply") in any case; null if it is none.
const Format* mesh_format(const std::string& extension);
/// True for the extension (".obj") of a mesh format, in any case.
bool is_mesh_extension(const std::string& extension);
/// Extensions of all mesh formats, in lower case.
std::vector<std::string> mesh_extensions();
/// Message about a lower-case extension that is_mesh_extension() refuses.
std::string unknown_mesh_extension(const std::string& extension);
/// Parts that a folder of mesh files can store, in a format (".ply") and with files beside it.
/// Throws std::invalid_argument for another extension.
HeldParts held_in_folder(const std::string& extension);

/// Formats of arrays and point caches; each is defined in the file of its format.
Format npy_format(), npz_format(), pc2_format(), mdd_format();

}  // namespace mimetra
