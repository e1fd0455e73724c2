#include "tests/fuzz/fuzz_target.h"
#include "toolkit/io/array_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/sequence_file.h"

namespace mimetra::fuzz {

namespace {

/// One that stands in one file, with its faces beside it where it has none.
TargetDescription sequence_target(const std::string& format) {
  return {format, "take." + format,
          [](const fs::path& file) {
            static const fs::path faces = [&file] {
              const fs::path made = file.parent_path() / "faces.ply";
              write_mesh(made, grid());
              return made;
            }();
            read_sequence(file.string(), {.topology = faces, .threads = 1});
          },
          [](const fs::path& file) {
            write_sequence(take(), file, {.overwrite = true, .threads = 1});
          }};
}

const Target kNpySequence(sequence_target("npy"));
const Target kNpz(sequence_target("npz"));
const Target kPc2(sequence_target("pc2"));
const Target kMdd(sequence_target("mdd"));

const Target kNpy({"npy_values", "values.npy", [](const fs::path& file) { read_npy(file); },
                   [](const fs::path& file) { write_npy_frames(file, take().positions()); }});

}  // namespace

}  // namespace mimetra::fuzz
