#include "toolkit/operations/format.h"

#include <algorithm>

#include "toolkit/io/material_library.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

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

}  // namespace mimetra
