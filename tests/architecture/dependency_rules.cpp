#include "tests/architecture/dependency_rules.h"

#include <algorithm>
#include <array>
#include <regex>
#include <set>
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
      {"MPI", {"mpi.h"}, {"MPI::"}},
      {"OpenBLAS", {"cblas.h", "lapacke.h", "openblas"}, {"BLAS::", "OpenBLAS"}},
      {"CHOLMOD", {"cholmod.h", "suitesparse/"}, {"SuiteSparse", "CHOLMOD"}},
      {"HDF5", {"hdf5", "H5"}, {"HDF5::", "hdf5::", "${HDF5_"}},
      {"JSON", {"nlohmann/"}, {"nlohmann_json::"}},
      {"libzip", {"zip.h"}, {"libzip::"}},
      {"zlib", {"zlib.h"}, {"ZLIB::", "${ZLIB_"}},
      {"libpng", {"png.h"}, {"PNG::"}},
      {"libjpeg", {"jpeglib.h"}, {"JPEG::"}},
      {"meshoptimizer", {"meshoptimizer.h"}, {"meshoptimizer"}},
      {"Draco", {"draco/"}, {"draco::"}},
      {"VTK's rendering",
       {"vtkActor", "vtkCamera", "vtkChart", "vtkContext", "vtkLight", "vtkPlot",
        "vtkPolyDataMapper", "vtkProperty", "vtkRender", "vtkText", "vtkGenericOpenGL"},
       {"VTK::Charts", "VTK::Rendering"}},
      {"VTK", {"vtk"}, {"VTK::", "${VTK_LIBRARIES"}},
      {"OpenGL", {"EGL/", "GL/"}, {"OpenGL::", "GLEW::"}},
      {"CLI11", {"CLI/"}, {"CLI11::"}},
      {"spdlog", {"spdlog/"}, {"spdlog::"}},
      {"fmt", {"fmt/"}, {"fmt::"}},
      {"xxHash", {"xxhash.h"}, {"xxHash::"}},
      {"dlib", {"dlib/"}, {"dlib"}},
      {"FFmpeg", {"libav", "libsw"}, {"${FFMPEG_"}},
      {"GoogleTest", {"gtest/", "gmock/"}, {"GTest::"}},
      {"Google Benchmark", {"benchmark/"}, {"benchmark::"}},
  };
  return table;
}

/// Headers of the operating system and of C. Those of C++ have no dot.
constexpr std::array<std::string_view, 12> kSystemHeaders = {
    "unistd.h",  "fcntl.h",  "poll.h",   "glob.h",  "dlfcn.h",  "sys/",
    "windows.h", "stddef.h", "stdint.h", "stdio.h", "stdlib.h", "string.h"};

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

/// The half-edges, and the bridge for users who have OpenMesh already.
bool is_openmesh_header(const fs::path& file) {
  return file == "toolkit/mesh/surface.h" || file == "toolkit/mesh/openmesh.h";
}

/// Shared by the .cpp files that know FFmpeg, and not installed.
bool is_ffmpeg_header(const fs::path& file) {
  return file == "fitting/ffmpeg.h";
}

std::optional<std::string> folder_error(const FolderRule& rule, const std::string& folder) {
  if (folder == rule.name || contains(rule.folders, folder)) return {};
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
  if (name == "OpenMesh" && is_openmesh_header(file)) return {};
  if (name == "FFmpeg" && is_ffmpeg_header(file)) return {};
  // JSON values come in and go out there.
  if (name == "JSON" && file == "toolkit/io/json_text.h") return {};
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

constexpr std::string_view kInstalled = "mimetra/";

/// `#include` of one line.
struct Include {
  int line;
  bool quoted;
  std::string header;

  bool is_as_installed() const { return !quoted && header.starts_with(kInstalled); }
  /// The file of the tree that is meant; none for one from elsewhere.
  std::optional<fs::path> of_the_tree() const {
    if (is_as_installed()) return header.substr(kInstalled.size());
    if (quoted || rule_for(header)) return header;
    return {};
  }
};

std::optional<std::string> include_error(const FolderRule& rule, const fs::path& file,
                                         const Include& include) {
  const std::optional<fs::path> target = include.of_the_tree();
  if (!target) return header_use_error(rule, file, include.header);
  const FolderRule* folder = rule_for(*target);
  return folder ? folder_error(rule, folder->name) : "no folder of the architecture holds it";
}

/// `library` may be a target, mimetra::io or mimetra_io, or a third party's.
std::optional<std::string> link_error(const FolderRule& rule, const std::string& library) {
  for (const std::string_view own : {"mimetra::", "mimetra_"}) {
    if (!library.starts_with(own)) continue;
    const std::string name = library.substr(own.size());
    const auto is_of_name = [&name](const FolderRule& other) { return other.name == name; };
    const bool is_folder = std::any_of(folder_rules().begin(), folder_rules().end(), is_of_name);
    return is_folder ? folder_error(rule, name) : std::nullopt;
  }
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

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex include(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)re");
  std::vector<Include> includes;
  for_each_line(text, [&](int number, const std::string& line) {
    std::smatch match;
    if (!std::regex_match(line, match, include)) return;
    includes.push_back({number, match.str(1) == "\"", match.str(2)});
  });
  return includes;
}

/// Programs that know an installation, as a user has it.
bool is_users_program(const fs::path& file) {
  return file.parent_path() == "samples" || is_inside(file, "samples/plugin") ||
         is_inside(file, "tests/c/programs") ||
         // The fitting module's own test where it is built alone.
         (is_inside(file, "tests/package") && !is_inside(file, "tests/package/fitting"));
}

/// A header and the source of its name.
fs::path unit_of(fs::path file) {
  return file.replace_extension();
}

using Units = std::map<fs::path, std::set<fs::path>>;

Units units_of(const Tree& sources) {
  Units units;
  for (const auto& [file, text] : sources) {
    std::set<fs::path>& used = units[unit_of(file)];
    for (const Include& include : includes_of(text)) {
      const auto target = include.of_the_tree();
      if (target && sources.contains(*target)) used.insert(unit_of(*target));
    }
    used.erase(unit_of(file));
  }
  return units;
}

/// Walks depth first, and notes each way back to where it has come through.
class CircleSearch {
 public:
  explicit CircleSearch(const Units& units) : units_(units) {
    for (const auto& [unit, used] : units) visit(unit);
  }

  std::vector<std::string> circles;

 private:
  void visit(const fs::path& unit) {
    if (done_.contains(unit)) return;
    const auto begin = std::find(path_.begin(), path_.end(), unit);
    if (begin != path_.end()) {
      std::string circle;
      for (auto each = begin; each != path_.end(); ++each)
        circle += each->generic_string() + " -> ";
      circles.push_back(circle + unit.generic_string());
      return;
    }
    path_.push_back(unit);
    for (const fs::path& used : units_.at(unit)) visit(used);
    path_.pop_back();
    done_.insert(unit);
  }

  const Units& units_;
  std::vector<fs::path> path_;
  std::set<fs::path> done_;
};

/// Headers that a folder's CMakeLists.txt installs.
std::set<fs::path> public_headers(const Tree& lists) {
  static const std::regex headers(R"re(HEADERS\s+((?:[\w/]+\.h\s*)+))re");
  static const std::regex word(R"re(\S+)re");
  std::set<fs::path> found;
  for (const auto& [list, text] : lists) {
    for (std::sregex_iterator each(text.begin(), text.end(), headers), end; each != end; ++each) {
      const std::string names = each->str(1);
      for (std::sregex_iterator name(names.begin(), names.end(), word); name != end; ++name) {
        found.insert(list.parent_path() / name->str());
      }
    }
  }
  return found;
}

}  // namespace

const std::vector<FolderRule>& folder_rules() {
  static const std::vector<FolderRule> rules = [] {
    const std::vector<std::string> below_pipeline = {
        "mesh", "geodesic", "model", "splocs", "regions", "correspondence", "transfer"};
    const auto with = [](std::vector<std::string> folders, const std::vector<std::string>& more) {
      folders.insert(folders.end(), more.begin(), more.end());
      return folders;
    };
    const std::vector<std::string> below_operations =
        with(below_pipeline, {"pipeline", "io", "format_gltf", "format_hdf5", "formats"});
    const std::vector<std::string> up_to_operations = with(below_operations, {"operations"});
    const std::vector<std::string> up_to_vtk = with(up_to_operations, {"vtk"});
    const std::vector<std::string> up_to_report =
        with(up_to_vtk, {"drawing", "pictures", "report"});
    // JSON goes wherever operations are declared, because their results are JSON.
    return std::vector<FolderRule>{
        {"mesh", "toolkit/mesh", {}, {"OpenMesh"}},
        {"geodesic", "geodesic", {"mesh"}, {"CGAL", "OpenMesh"}},
        {"model", "toolkit/model", {"mesh"}},
        {"splocs", "toolkit/splocs", {"mesh", "geodesic"}, {"OpenMesh", "OpenBLAS"}},
        {"regions", "toolkit/regions", {"splocs", "mesh", "geodesic"}, {"OpenMesh"}},
        {"correspondence", "toolkit/correspondence", {"mesh", "geodesic"}, {"CGAL", "OpenMesh"}},
        {"transfer",
         "toolkit/transfer",
         {"model", "regions", "correspondence", "mesh", "geodesic"},
         {"OpenMesh", "CHOLMOD"}},
        {"pipeline", "toolkit/pipeline", below_pipeline},
        {"io",
         "toolkit/io",
         {"mesh", "model", "splocs", "regions", "correspondence"},
         {"OpenMesh", "JSON", "libzip", "zlib", "libpng", "libjpeg"}},
        {"format_gltf",
         "toolkit/formats/gltf",
         {"mesh", "model", "io"},
         {"JSON", "meshoptimizer", "Draco"}},
        {"format_hdf5", "toolkit/formats/hdf5", {"mesh", "splocs", "io"}, {"zlib"}},
        {"formats",
         "toolkit/formats",
         {"mesh", "model", "splocs", "regions", "io", "format_gltf", "format_hdf5"},
         {"JSON"}},
        {"operations", "toolkit/operations", below_operations, {"JSON", "xxHash"}},
        {"vtk", "toolkit/vtk", up_to_operations, {"VTK", "JSON"}},
        {"drawing", "toolkit/drawing", up_to_vtk, {"VTK", "VTK's rendering", "OpenGL"}},
        {"pictures", "toolkit/pictures", with(up_to_vtk, {"drawing"}), {"JSON"}},
        {"report", "toolkit/report", with(up_to_vtk, {"drawing", "pictures"}), {"VTK", "JSON"}},
        {"fitting",
         "fitting",
         {"mesh", "model", "correspondence", "io", "formats", "operations"},
         {"dlib", "FFmpeg", "JSON"}},
        {"samples", "samples/head", up_to_operations, {"JSON"}},
        // The C interface makes values of all kinds, and shows them.
        {"c", "plugins/c", with(up_to_operations, {"fitting", "samples"}), {"JSON"}},
        {"interface", "plugins/pictures", with(up_to_report, {"fitting", "samples", "c"})},
        {"programs", "samples", with(up_to_report, {"fitting", "samples"}), {}, true},
        // Plugins of third parties, which know only the C header.
        {"plugin", "samples/plugin", {"c"}},
        {"cli",
         "toolkit/cli",
         {"mesh", "splocs", "io", "format_hdf5", "formats", "operations", "vtk", "pictures",
          "report", "fitting", "samples", "c"},
         {"CLI11", "spdlog", "fmt", "JSON", "MPI"}},
        {"paraview",
         "plugins/paraview",
         {"mesh", "pipeline", "io", "operations", "vtk", "c"},
         {},
         true},
        {"meshlab", "plugins/meshlab", {"operations", "c"}, {}, true},
        {"blender", "plugins/blender", {"operations", "c"}, {}, true},
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
  const FolderRule* rule = rule_for(file);
  if (!rule) return {file.generic_string() + ": no folder of the architecture holds this file"};
  std::vector<std::string> errors;
  for (const Include& include : includes_of(text)) {
    const auto error = include_error(*rule, file, include);
    if (error) errors.push_back(place(file, include.line) + include.header + ": " + *error);
  }
  return errors;
}

std::vector<std::string> link_errors(const fs::path& file, const std::string& text) {
  // The target in a generator expression, $<LINK_ONLY:dlib::dlib>, is a separate word.
  static const std::regex word(R"re((?:[^\s()"<>$:]|::|\$\{)+)re");
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

std::vector<std::string> path_errors(const Tree& sources) {
  std::vector<std::string> errors;
  for (const auto& [file, text] : sources) {
    for (const Include& include : includes_of(text)) {
      const auto target = include.of_the_tree();
      if (!target) continue;
      const std::string start = place(file, include.line) + include.header + ": ";
      if (!sources.contains(*target)) errors.push_back(start + "is not a file of the tree");
      // Files that only a test of users' programs includes are not installed.
      const bool as_user = is_users_program(file) && !is_inside(*target, "tests");
      if (as_user ? include.is_as_installed() : include.quoted) continue;
      const std::string path = target->generic_string();
      errors.push_back(start + "write " + (as_user ? "<mimetra/" + path + ">" : '"' + path + '"'));
    }
  }
  return errors;
}

std::vector<std::string> private_header_errors(const Tree& sources, const Tree& lists) {
  const std::set<fs::path> installed = public_headers(lists);
  std::vector<std::string> errors;
  for (const auto& [file, text] : sources) {
    for (const Include& include : includes_of(text)) {
      const auto target = include.of_the_tree();
      if (!target || rule_for(*target) == rule_for(file) || installed.contains(*target)) continue;
      errors.push_back(place(file, include.line) + include.header +
                       ": is private to its folder; its CMakeLists.txt does not install it");
    }
  }
  return errors;
}

std::vector<std::string> name_errors(const Tree& sources) {
  // The first version's header, with which old programs are built.
  const fs::path kept = "tests/c/programs/version_1/mimetra.h";
  std::map<fs::path, fs::path> first;
  std::vector<std::string> errors;
  for (const auto& [file, text] : sources) {
    if (!is_header(file) || file == kept) continue;
    const auto [other, is_new] = first.emplace(file.filename(), file);
    if (is_new) continue;
    errors.push_back(file.generic_string() + ": has the name of " + other->second.generic_string());
  }
  return errors;
}

std::vector<std::string> circles(const Tree& sources) {
  const Units units = units_of(sources);
  return CircleSearch(units).circles;
}

}  // namespace mimetra::test
