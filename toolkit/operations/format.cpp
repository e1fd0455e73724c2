#include "toolkit/operations/format.h"

#include <algorithm>

#include "toolkit/io/material_library.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

using Paths = std::vector<std::filesystem::path>;

std::string word_of(const std::string& extension) {
  if (extension == Format::kFolder) return "a folder";
  return extension == Format::kAnyFile ? "any file" : extension;
}

}  // namespace

bool Format::has(const std::string& extension) const {
  return std::ranges::find(extensions, extension) != extensions.end();
}

std::vector<Parameter> Format::options() const {
  std::vector<Parameter> all = reading;
  for (const Parameter& option : writing) {
    if (std::ranges::find(all, option.name, &Parameter::name) == all.end()) all.push_back(option);
  }
  return all;
}

std::string listed_extensions(std::vector<std::string> extensions) {
  std::stable_partition(extensions.begin(), extensions.end(),
                        [](const auto& each) { return each.starts_with('.'); });
  std::vector<std::string> words;
  for (const std::string& extension : extensions) {
    const std::string word = word_of(extension);
    if (std::ranges::find(words, word) == words.end()) words.push_back(word);
  }
  return joined(words, ", ", " or ");
}

std::vector<std::string> notes_on_losses(const Format& format, const Data& data,
                                         const WriteRequest& request) {
  if (format.losses) return format.losses(data, request.target);
  const auto* sequence = std::get_if<FieldSequence>(&data);
  if (!sequence || format.weights) return {};
  std::vector<std::string> notes;
  if (!sequence->fields.empty() && !format.fields) {
    std::vector<std::string> names;
    for (const Field& field : sequence->fields) names.push_back(field.name);
    notes.push_back(request.target.string() + ": this format holds no fields; without " +
                    joined(names));
  }
  if (format.displacements && std::ranges::any_of(sequence->fields, is_displacement) &&
      has_left_its_rest(*sequence->frames)) {
    notes.push_back(request.target.string() + ": the input's field '" + kDisplacement +
                    "' is replaced by the displacement from the rest pose; give it another name to "
                    "keep it");
  }
  if (!format.holds) return notes;
  const HeldParts held = format.holds(request.parameters);
  const auto lost = parts_left_out(held, *sequence->frames);
  if (!lost.empty()) {
    notes.push_back(request.target.string() + ": this format holds no " +
                    joined(lost, ", ", " or ") + "; written without");
  }
  if (held.groups) {
    const Connectivity& connectivity = sequence->frames->connectivity();
    const bool is_folder = format.has(Format::kFolder);
    const WrittenMaterials materials = is_folder ? materials_in_folder(connectivity, request.target)
                                                 : materials_beside(connectivity, request.target);
    notes.insert(notes.end(), materials.notes.begin(), materials.notes.end());
  }
  return notes;
}

Paths write_with_extra(const WriteRequest& request, const std::function<Paths()>& write) {
  // Makes parent folders of the target first; they are removed again if writing fails.
  PendingOutputs extra(request.overwrite, request.inputs, request.together);
  Paths beside;
  for (const auto& [name, content] : request.extra) {
    beside.push_back(request.target.parent_path() / name);
    write_bytes(extra.add(beside.back(), PendingOutput::Kind::file, existing_beside(name)),
                content);
  }
  Paths written = write();
  extra.commit();
  written.insert(written.end(), beside.begin(), beside.end());
  return written;
}

Paths write_text(const WriteRequest& request, const std::string& text) {
  return write_with_extra(request, [&]() -> Paths {
    write_file(request.target, text, request.overwrite, request.together);
    return {request.target};
  });
}

Paths write_document(const Data& document, const WriteRequest& request, const Context&) {
  return write_text(request, std::get<Document>(document).text);
}

}  // namespace mimetra
