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
  /// With those of the format.
  const Parameters& parameters;
  /// A sequence with its fields; a model that keeps its identities, otherwise it is one person.
  bool fields = false;
  bool identities = false;
  /// A sequence may read its frames later.
  bool may_stream = false;
  /// The mesh that a region set is for.
  int vertices = 0;
  const Triangles* triangles = nullptr;
};

/// A value, and what was noticed while reading it.
struct ReadValue {
  NamedData value;
  /// All that was read, for the manifest.
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
};

/// Where and how a value is written.
struct WriteRequest {
  std::filesystem::path target;
  const Parameters& parameters;
  bool overwrite = false;
  /// Files and folders that were read for it, which must stay.
  std::vector<std::filesystem::path> inputs = {};
  /// Outputs that it appears together with; alone without.
  PendingOutputs* together = nullptr;
  /// Further files (name, content) that appear together with the output.
  std::vector<std::pair<std::string, std::string>> extra = {};
};

/// A way to read and to write one kind of value, declared once: what is read and written, and every
/// list of formats, comes from it.
struct Format {
  /// What is not a file has no extension: a folder, a pattern, MODEL@identity=1.5.
  static constexpr auto kFolder = "";
  static constexpr auto kAnyFile = "*";

  std::string name;  ///< "PC2 point cache"
  DataKind kind;
  /// In lower case, such as ".pc2"; or kFolder alone; or kAnyFile alone.
  std::vector<std::string> extensions;
  /// Options of reading.
  std::vector<Parameter> reading = {};
  /// Throws IoError, MismatchError, Cancelled; not set where it is not read.
  std::function<ReadValue(const std::string& text, const ReadRequest&, const Context&)> read = {};
  /// Options of writing.
  std::vector<Parameter> writing = {};
  /// Writes atomically; returns the files. Throws OutputError, MismatchError, Cancelled; not set
  /// where it is not written.
  std::function<std::vector<std::filesystem::path>(const Data&, const WriteRequest&,
                                                   const Context&)>
      write = {};
  /// A sequence keeps its fields.
  bool fields = false;
  /// Displacements from a rest pose take the place of fields of their names: show_displacement().
  bool displacements = false;
  /// What else of a sequence its files have a place for, with these options; where it is not set
  /// nothing is said.
  std::function<HeldParts(const Parameters&)> holds = {};
  /// It holds blendshape weights, a table's or those that drive a sequence: for outputs that say
  /// so.
  bool weights = false;
  /// What a value loses in it, as notes; where it is not set nothing is said.
  std::function<std::vector<std::string>(const Data&, const std::filesystem::path&)> losses = {};

  bool has(const std::string& extension) const;
  /// Those of reading and of writing, each once.
  std::vector<Parameter> options() const;
};

/// ".json, .csv or a folder": what formats are called in messages and help.
std::string listed_extensions(std::vector<std::string> extensions);

/// What is to be said of all that a format leaves out of a sequence, such as "out.stl: this format
/// holds no texture coordinates or order of vertices; written without". None where it holds all.
std::vector<std::string> notes_on_losses(const Format& format, const Data& data,
                                         const WriteRequest& request);

/// Calls `write`, which makes the request's target and returns its files, and lets the request's
/// further files appear beside it right after; where either fails, nothing appears. Returns all
/// files. Throws OutputError.
std::vector<std::filesystem::path> write_with_extra(
    const WriteRequest& request, const std::function<std::vector<std::filesystem::path>()>& write);

/// Writes `text` to the request's target, and its further files beside it. Returns all files.
/// Throws OutputError.
std::vector<std::filesystem::path> write_text(const WriteRequest& request, const std::string& text);

/// The same with the text of a document.
std::vector<std::filesystem::path> write_document(const Data& document, const WriteRequest& request,
                                                  const Context& context = {});

}  // namespace mimetra
