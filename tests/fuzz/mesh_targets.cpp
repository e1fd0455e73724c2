#include "tests/fuzz/fuzz_target.h"
#include "toolkit/io/mesh_file.h"

namespace mimetra::fuzz {

namespace {

TargetDescription mesh_target(const std::string& format) {
  return {format, "mesh." + format, [](const fs::path& file) { read_mesh(file); },
          [](const fs::path& file) { write_mesh(file, grid()); }};
}

const Target kObj(mesh_target("obj"));
const Target kPly(mesh_target("ply"));
const Target kOff(mesh_target("off"));
const Target kStl(mesh_target("stl"));

/// The quick reader of the frames after the first, which finds its places in that one.
const Target kFrame({"obj_frame", "frame.obj",
                     [](const fs::path& file) {
                       static const MeshFileReader first = [&file] {
                         const fs::path sound = file.parent_path() / "first.obj";
                         write_mesh(sound, grid());
                         return MeshFileReader(sound);
                       }();
                       first.read(file);
                     },
                     [](const fs::path& file) { write_mesh(file, grid()); }});

}  // namespace

}  // namespace mimetra::fuzz
