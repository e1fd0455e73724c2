#include "dependency_rules.h"

#include <algorithm>
#include <array>
#include <regex>
#include <sstream>
#include <string_view>

namespace mimetra::test {
namespace {

namespace fs = std::filesystem;

/// How a third party shows: the beginning of its headers and of its CMake targets or variables.
struct ThirdParty {
  std::string_view name;
  std::vector<std::string_view> headers;
  std::vector<std::string_view> targets;
};

const std::vector<ThirdParty>& third_parties() {
  static const std::vector<ThirdParty> table = {
      {"Eigen", {"Eigen/", "unsupported/Eigen/"}, {"Eigen3::"}},
      {"OpenMesh", {"OpenMesh/"}, {"OpenMeshCore", "OpenMeshTools"}},
      {"CGAL", {"CGAL/"}, {"CGAL::"}},
      {"OpenBLAS", {"cblas.h", "lapacke.h", "openblas"}, {"BLAS::", "OpenBLAS"}},
      {"CHOLMOD", {"cholmod.h", "suitesparse/"}, {"SuiteSparse", "CHOLMOD"}},
      {"HDF5", {"hdf5", "H5"}, {"HDF5::", "hdf5::", "${HDF5_"}},
      {"JSON", {"nlohmann/"}, {"nlohmann_json::"}},
      {"zlib", {"zlib.h"}, {"ZLIB::", "${ZLIB_"}},
      {"tinygltf", {"tiny_gltf.h"}, {"tinygltf"}},
      {"VTK", {"vtk"}, {"VTK::", "${VTK_LIBRARIES"}},
      {"EGL", {"EGL/"}, {"OpenGL::EGL"}},
      {"CLI11", {"CLI/"}, {"CLI11::"}},
      {"spdlog", {"spdlog/"}, {"spdlog::"}},
      {"fmt", {"fmt/"}, {"fmt::"}},
      {"xxHash", {"xxhash.h"}, {"xxHash::"}},
      {"dlib", {"dlib/"}, {"dlib"}},
      {"GoogleTest", {"gtest/", "gmock/"}, {"GTest::"}},
      {"Google Benchmark", {"benchmark/"}, {"benchmark::"}},
  };
  return table;
}

/// Headers of the operating system and of C. Those of C++ have no dot.
constexpr std::array<std::string_view, 11> kSystemHeaders = {
    "unistd.h",  "fcntl.h",  "poll.h",   "glob.h",   "dlfcn.h", "sys/",
    "windows.h", "stddef.h", "stdint.h", "stdlib.h", "string.h"};

bool contains(const std::vector<std::string>& list, std::string_view item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

template <typename Prefixes>
bool starts_with_any(std::string_view text, const Prefixes& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [text](std::string_view prefix) { return text.starts_with(prefix); });
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "nothing" : text;
}

bool is_inside(const fs::path& file, const fs::path& folder) {
  const auto [last_of_folder, in_file] =
      std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return last_of_folder == folder.end() && in_file != file.end();
}

bool is_header(const fs::path& file) {
  return file.extension().string().starts_with(".h");
}

/// vtkPolyData.h, not our own vtk_formats.h.
bool is_vtk_header(std::string_view header) {
  return header.starts_with("vtk") && header.size() > 3 && header[3] >= 'A' && header[3] <= 'Z';
}

bool is_bridge_header(const fs::path& file) {
  return file == "toolkit/mesh/openmesh.h";
}

std::optional<std::string> folder_error(const FolderRule& rule, const std::string& folder) {
  if (folder == rule.name() || contains(rule.folders, folder)) return {};
  return rule.path + " may not use " + folder + " (only " + joined(rule.folders) + ")";
}

std::optional<std::string> third_party_error(const FolderRule& rule, std::string_view name) {
  if (name == "Eigen" || rule.any_third_party || contains(rule.third_parties, name)) return {};
  return rule.path + " may not use " + std::string(name) + " (only Eigen and " +
         joined(rule.third_parties) + ")";
}

/// Users of the libraries must not need third parties to compile against them.
std::optional<std::string> header_error(const FolderRule& rule, const fs::path& file,
                                        std::string_view name) {
  if (!is_header(file) || name == "Eigen" || rule.any_third_party) return {};
  if (name == "OpenMesh" && is_bridge_header(file)) return {};
  // An operation's result is a JSON value.
  if (name == "JSON" && rule.name() == "operations") return {};
  return std::string(name) + " belongs into .cpp files, not into headers";
}

std::optional<std::string> header_use_error(const FolderRule& rule, const fs::path& file,
                                            const std::string& header) {
  for (const ThirdParty& party : third_parties()) {
    if (!starts_with_any(header, party.headers)) continue;
    const auto error = third_party_error(rule, party.name);
    return error ? error : header_error(rule, file, party.name);
  }
  const bool known =
      header.find('.') == std::string::npos || starts_with_any(header, kSystemHeaders);
  if (known || rule.any_third_party) return {};
  return "this third party is not in the table of dependency_rules.cpp";
}

std::optional<std::string> include_error(const FolderRule& rule, const fs::path& file, char kind,
                                         const std::string& header) {
  constexpr std::string_view kOwn = "mimetra/";
  if (header.starts_with(kOwn)) {
    const auto end = header.find('/', kOwn.size());
    return folder_error(rule, header.substr(kOwn.size(), end - kOwn.size()));
  }
  // Quotes also find headers outside the project, and VTK's lie in no folder of their own.
  const bool local = kind == '"' && (header.find("..") != std::string::npos ||
                                     header.find('/') == std::string::npos);
  if (local && !is_vtk_header(header)) {
    const fs::path target = (file.parent_path() / header).lexically_normal();
    if (is_inside(target, rule.path)) return {};
    return "quotes lead out of " + rule.path + "; write <mimetra/FOLDER/...>";
  }
  return header_use_error(rule, file, header);
}

std::optional<std::string> link_error(const FolderRule& rule, const std::string& library) {
  constexpr std::string_view kOwn = "mimetra::";
  if (library.starts_with(kOwn)) return folder_error(rule, library.substr(kOwn.size()));
  for (const ThirdParty& party : third_parties()) {
    if (starts_with_any(library, party.targets)) return third_party_error(rule, party.name);
  }
  return {};
}

/// Calls `visit(line number, line)`.
template <typename Visit>
void for_each_line(const std::string& text, Visit visit) {
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) visit(++number, line);
}

std::string place(const fs::path& file, int line) {
  return file.generic_string() + ":" + std::to_string(line) + ": ";
}

}  // namespace

const std::vector<FolderRule>& folder_rules() {
  static const std::vector<FolderRule> rules = [] {
    const std::vector<std::string> above_operations = {"geodesic", "mesh",     "model", "splocs",
                                                       "regions",  "transfer", "io"};
    std::vector<std::string> up_to_operations = above_operations;
    up_to_operations.push_back("operations");
    std::vector<std::string> all = up_to_operations;
    all.insert(all.end(), {"vtk", "fitting"});
    // The C interface makes values of all kinds, and shows them.
    std::vector<std::string> values_and_operations = up_to_operations;
    values_and_operations.insert(values_and_operations.end(), {"fitting", "samples"});
    // JSON goes wherever operations are declared, because their results are JSON.
    return std::vector<FolderRule>{
        {"geodesic", {}, {"CGAL", "OpenMesh"}},
        {"toolkit/mesh", {"geodesic"}, {"OpenMesh"}},
        {"toolkit/model", {"mesh"}, {}},
        {"toolkit/splocs", {"mesh", "geodesic"}, {"OpenMesh", "OpenBLAS"}},
        {"toolkit/regions", {"splocs", "mesh", "geodesic"}, {"OpenMesh"}},
        {"toolkit/transfer", {"model", "regions", "mesh", "geodesic"}, {"OpenMesh", "CHOLMOD"}},
        {"toolkit/io",
         {"mesh", "model", "splocs", "regions"},
         {"OpenMesh", "HDF5", "JSON", "zlib", "tinygltf"}},
        {"toolkit/operations", above_operations, {"JSON", "xxHash"}},
        {"toolkit/vtk", up_to_operations, {"VTK", "EGL", "JSON"}},
        {"fitting", {"mesh", "model", "io", "operations"}, {"dlib", "JSON"}},
        {"samples", all, {}, true},
        {"plugins/c", values_and_operations, {"JSON"}},
        // What third parties write, who have nothing but the C header.
        {"samples/plugin", {"c"}, {}},
        {"toolkit/cli",
         {"operations", "vtk", "fitting", "samples", "c"},
         {"CLI11", "spdlog", "fmt", "JSON"}},
        {"plugins/paraview", {"operations", "vtk", "c"}, {}, true},
        {"plugins/meshlab", {"operations", "c"}, {}, true},
        {"plugins/blender", {"operations", "c"}, {}, true},
    };
  }();
  return rules;
}

const FolderRule* rule_for(const fs::path& file) {
  const FolderRule* nearest = nullptr;
  for (const FolderRule& rule : folder_rules()) {
    const bool is_nearer = !nearest || rule.path.size() > nearest->path.size();
    if (is_inside(file, rule.path) && is_nearer) nearest = &rule;
  }
  return nearest;
}

std::vector<std::string> include_errors(const fs::path& file, const std::string& text) {
  static const std::regex include(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)re");
  const FolderRule* rule = rule_for(file);
  if (!rule) return {file.generic_string() + ": no folder of the architecture holds this file"};
  std::vector<std::string> errors;
  for_each_line(text, [&](int number, const std::string& line) {
    std::smatch match;
    if (!std::regex_match(line, match, include)) return;
    const auto error = include_error(*rule, file, match.str(1)[0], match.str(2));
    if (error) errors.push_back(place(file, number) + match.str(2) + ": " + *error);
  });
  return errors;
}

std::vector<std::string> link_errors(const fs::path& file, const std::string& text) {
  static const std::regex word(R"re([^\s()"]+)re");
  const FolderRule* rule = rule_for(file);
  if (!rule) return {};
  std::vector<std::string> errors;
  for_each_line(text, [&](int number, const std::string& line) {
    const std::string code = line.substr(0, line.find('#'));
    for (std::sregex_iterator found(code.begin(), code.end(), word), end; found != end; ++found) {
      if (const auto error = link_error(*rule, found->str())) {
        errors.push_back(place(file, number) + found->str() + ": " + *error);
      }
    }
  });
  return errors;
}

}  // namespace mimetra::test
