#include "toolkit/operations/format.h"

#include <algorithm>

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
  std::ranges::stable_partition(extensions, [](const auto& each) { return each.starts_with('.'); });
  std::vector<std::string> words;
  for (const std::string& extension : extensions) {
    const std::string word = word_of(extension);
    if (std::ranges::find(words, word) == words.end()) words.push_back(word);
  }
  return joined(words, ", ", " or ");
}

std::string note_on_fields(const Format& format, const Data& data,
                           const std::filesystem::path& target) {
  const auto* sequence = std::get_if<FieldSequence>(&data);
  if (!sequence || sequence->fields.empty() || format.fields) return "";
  std::vector<std::string> names;
  for (const Field& field : sequence->fields) names.push_back(field.name);
  return target.string() + ": this format holds no fields; without " + joined(names);
}

}  // namespace mimetra
