#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/io/mesh_formats.h"
#include "toolkit/mesh/context.h"
#include "toolkit/operations/data.h"
#include "toolkit/operations/parameter.h"

namespace mimetra {

class PendingOutputs;

/// How a value is read.
struct ReadRequest {
  /// Includes the format's parameters.
  const Parameters& parameters;
  /// `fields`: read a sequence with its fields. `identities`: keep a model's identities, instead of
  /// reading one person.
  bool fields = false;
  bool identities = false;
  /// A sequence may read its frames later.
  bool may_stream = false;
  /// Mesh of a region set.
  int vertices = 0;
  const Triangles* triangles = nullptr;
};

/// A value and the reader's notes.
struct ReadValue {
  NamedData value;
  /// All files that were read, for the manifest.
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
};

/// Where and how a value is written.
struct WriteRequest {
  std::filesystem::path target;
  const Parameters& parameters;
  bool overwrite = false;
  /// Input files and folders, which must not be overwritten.
  std::vector<std::filesystem::path> inputs = {};
  /// Outputs that appear at the same time; null if the output appears alone.
  PendingOutputs* together = nullptr;
  /// Further files (name, content) that appear together with the output.
  std::vector<std::pair<std::string, std::string>> extra = {};
};

/// A way to read and write one kind of value, declared once. Readers, writers and every list of
/// formats use this declaration.
struct Format {
  /// Texts other than files have no extension: a folder, a pattern, MODEL@identity=1.5.
  static constexpr auto kFolder = "";
  static constexpr auto kAnyFile = "*";

  std::string name;  ///< "PC2 point cache"
  DataKind kind;
  /// Extensions in lower case, such as ".pc2"; or only kFolder, or only kAnyFile.
  std::vector<std::string> extensions;
  /// Parameters for reading.
  std::vector<Parameter> reading = {};
  /// Reads a value; empty for formats that are only written. Throws IoError, MismatchError,
  /// Cancelled.
  std::function<ReadValue(const std::string& text, const ReadRequest&, const Context&)> read = {};
  /// Files with a number in their name are frames of one sequence, also in a folder.
  bool numbered = false;
  /// Parameters for writing.
  std::vector<Parameter> writing = {};
  /// Writes a value atomically and returns the files; empty for formats that are only read. Throws
  /// OutputError, MismatchError, Cancelled.
  std::function<std::vector<std::filesystem::path>(const Data&, const WriteRequest&,
                                                   const Context&)>
      write = {};
  /// A sequence keeps its fields.
  bool fields = false;
  /// Displacements from a rest pose replace fields of the same name: show_displacement().
  bool displacements = false;
  /// Other parts of a sequence that the files can store, with these options. If empty, losses are
  /// not reported.
  std::function<HeldParts(const Parameters&)> holds = {};
  /// The format stores blendshape weights, from a table or from a sequence that they drive. Only
  /// outputs with Output::weights use it.
  bool weights = false;
  /// Notes on what a value loses in this format. If empty, losses are not reported.
  std::function<std::vector<std::string>(const Data&, const std::filesystem::path&)> losses = {};

  bool has(const std::string& extension) const;
  /// Parameters for reading and writing, each once.
  std::vector<Parameter> options() const;
};

/// List of extensions for messages and help: ".json, .csv or a folder".
std::string listed_extensions(std::vector<std::string> extensions);

/// Notes on everything that a format drops from a sequence. An example is "out.stl: this format
/// holds no texture coordinates or order of vertices; written without". Empty if the format stores
/// all.
std::vector<std::string> notes_on_losses(const Format& format, const Data& data,
                                         const WriteRequest& request);

/// Calls `write`, which makes the request's target and returns its files. The request's further
/// files appear beside the target immediately afterwards. If either fails, no file appears. Returns
/// all files. Throws OutputError.
std::vector<std::filesystem::path> write_with_extra(
    const WriteRequest& request, const std::function<std::vector<std::filesystem::path>()>& write);

/// Writes `text` to the request's target, and its further files beside it. Returns all files.
/// Throws OutputError.
std::vector<std::filesystem::path> write_text(const WriteRequest& request, const std::string& text);

/// As write_text(), with the text of a document.
std::vector<std::filesystem::path> write_document(const Data& document, const WriteRequest& request,
                                                  const Context& context = {});

}  // namespace mimetra
