#include "tests/fuzz/fuzz_target.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>

#include <unistd.h>

#include "toolkit/mesh/errors.h"

namespace mimetra::fuzz {

namespace {

std::map<std::string, TargetDescription>& targets() {
  static std::map<std::string, TargetDescription> all;
  return all;
}

/// In memory, and gone with the process.
const fs::path& own_folder() {
  static const fs::path folder = [] {
    fs::path made = "/dev/shm/mimetra_fuzz_" + std::to_string(getpid());
    fs::create_directories(made);
    std::atexit([] { fs::remove_all(own_folder()); });
    return made;
  }();
  return folder;
}

const TargetDescription& chosen() {
  const char* name = std::getenv("FUZZ_TARGET");
  const auto found = targets().find(name ? name : "");
  if (found != targets().end()) return found->second;
  std::cerr << "mimetra_fuzz: set FUZZ_TARGET to one of those that --list prints\n";
  std::exit(2);
}

/// `--list` prints the targets; `--seeds FOLDER` writes a sound file of each into its folder.
void serve(const std::vector<std::string>& arguments) {
  if (arguments.size() > 1 && arguments[1] == "--list") {
    for (const auto& [name, target] : targets()) std::cout << name << '\n';
    std::exit(0);
  }
  if (arguments.size() > 2 && arguments[1] == "--seeds") {
    for (const auto& [name, target] : targets()) {
      const fs::path folder = fs::path(arguments[2]) / name;
      fs::create_directories(folder);
      target.write(own_folder() / target.file);
      fs::copy_file(own_folder() / target.file, folder / target.file,
                    fs::copy_options::overwrite_existing);
    }
    std::exit(0);
  }
}

}  // namespace

Target::Target(TargetDescription description) {
  targets()[description.name] = std::move(description);
}

const TriMesh& grid() {
  static const TriMesh mesh = [] {
    Positions positions(9, 3);
    for (int v = 0; v < 9; ++v) positions.row(v) << v % 3, v / 3, 0.25 * (v % 2);
    Polygons polygons;
    for (const int corner : {0, 1, 3, 4}) {
      for (const int at : {corner, corner + 1, corner + 4, corner, corner + 4, corner + 3}) {
        polygons.corners.push_back(at);
        if (polygons.corners.size() % 3 == 0) {
          polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
        }
      }
    }
    return TriMesh{positions, Connectivity::from_polygons(9, std::move(polygons))};
  }();
  return mesh;
}

MeshSequence take() {
  Frames frames(3, 27);
  for (int f = 0; f < 3; ++f) {
    Positions moved = grid().positions;
    moved(4, 2) += f;
    frames.row(f) = Eigen::Map<const Eigen::RowVectorXd>(moved.data(), moved.size());
  }
  return {grid().connectivity, frames, Eigen::Vector3d(0, 0.04, 0.08)};
}

}  // namespace mimetra::fuzz

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  mimetra::fuzz::serve({*arguments, *arguments + *count});
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace mimetra;
  static const fuzz::TargetDescription& target = fuzz::chosen();
  static const std::filesystem::path file = fuzz::own_folder() / target.file;
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  try {
    target.read(file);
  } catch (const IoError&) {
    return 0;
  } catch (const OutputError&) {
    return 0;
  } catch (const std::invalid_argument&) {
    return 0;
  }
  return 0;
}
