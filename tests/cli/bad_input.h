#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/command_fixture.h"

namespace mimetra::test {

namespace fs = std::filesystem;

/// Something wrong or unusual in what the command is given, and what it must do about it.
struct BadInput {
  std::string kind;                           ///< the class: "truncated"
  std::string subject;                        ///< reader or operation: "ply_binary"
  std::function<void(const fs::path&)> make;  ///< writes what is wrong into a folder; may be empty
  std::string arguments;
  int code;
  /// Parts of the message on stderr; where the input is accepted, of stdout or stderr.
  std::vector<std::string> says;
  std::string prefix = "";  ///< the shell's words before the command: limits of the system
};

/// Adds a case of these members.
inline void add_case(std::vector<BadInput>& cases, std::string kind, std::string subject,
                     std::function<void(const fs::path&)> make, std::string arguments, int code,
                     std::vector<std::string> says, std::string prefix = "") {
  cases.push_back({std::move(kind), std::move(subject), std::move(make), std::move(arguments), code,
                   std::move(says), std::move(prefix)});
}

/// The cases, by what they are about. A folder that they work in holds a model `head` of 225
/// vertices with the expressions left, right and top, and `take.csv`, 12 frames of its weights.
std::vector<BadInput> mesh_cases();
std::vector<BadInput> sequence_cases();
std::vector<BadInput> array_cases();
std::vector<BadInput> hdf5_cases();
std::vector<BadInput> scene_cases();
std::vector<BadInput> model_cases();
std::vector<BadInput> weight_cases();
std::vector<BadInput> eos_cases();
std::vector<BadInput> component_cases();
std::vector<BadInput> fit_cases();
std::vector<BadInput> region_cases();
std::vector<BadInput> paint_cases();
std::vector<BadInput> json_cases();
std::vector<BadInput> match_cases();
std::vector<BadInput> rig_cases();
std::vector<BadInput> motion_cases();
std::vector<BadInput> retarget_cases();
std::vector<BadInput> geometry_cases();
std::vector<BadInput> request_cases();
std::vector<BadInput> output_cases();
std::vector<BadInput> hostile_cases();

/// A mesh that may be wrong in any way, to be written without any help of the library.
struct RawMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::vector<int>> faces;  ///< 0-based
  int more_vertices = 0;                ///< what the header claims too much
  int more_faces = 0;
};

/// Four vertices of a unit square, its lower right and its upper left triangle, lifted at one
/// corner.
inline RawMesh square(double lift = 0) {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, lift}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, 0, 0};
}

/// The file's bytes in "obj", "ply", "ply_binary", "off", "stl" or "stl_binary".
std::string bytes_of(const RawMesh& mesh, const std::string& format);

/// "ply" for "ply_binary".
inline std::string extension_of(const std::string& format) {
  return format.substr(0, format.find('_'));
}

inline void write_bytes_to(const fs::path& path, const std::string& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Writes the same bytes whatever the folder holds.
inline std::function<void(const fs::path&)> file(const std::string& name,
                                                 const std::string& bytes) {
  return [name, bytes](const fs::path& folder) { write_bytes_to(folder / name, bytes); };
}

/// What every test of the command finds in its folder, for cases that need a variant of it.
struct Patch : CommandTest {
  using CommandTest::model;
  using CommandTest::performance;
};

template <typename Number>
void append_raw(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace mimetra::test
