#include "tests/bench/io_bench.h"

#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/array_file.h"

namespace mimetra::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGroup = "files";

WriteOptions in_format(const std::string& format) {
  WriteOptions options;
  options.frame_format = format;
  options.overwrite = true;
  return options;
}

}  // namespace

std::vector<Row> io_rows(const Subject& subject, const fs::path& scratch,
                         const Settings& settings) {
  const MeshSequence& performance = subject.performance;
  const Size size{subject.name, performance.frames(), performance.vertices()};
  const double in_memory = 8.0 * static_cast<double>(performance.positions().size());
  std::vector<Case> cases;
  const auto add = [&](const std::string& what, double file_bytes, auto run) {
    // The files are read or written once, the positions the other way.
    cases.push_back(
        {{kGroup, what, size, {0, file_bytes + in_memory}, {"", 0, file_bytes}}, std::move(run)});
  };
  for (const std::string name : {"obj", "ply"}) {
    const fs::path folder = scratch / name;
    write_sequence(performance, folder, in_format(name));
    const double bytes = bytes_below(folder);
    add("read " + name + " files", bytes, [folder] { read_sequence(folder); });
    add("write " + name + " files", bytes,
        [folder, name, &performance] { write_sequence(performance, folder, in_format(name)); });
  }
  const fs::path array = scratch / "array.npy";
  write_npy_frames(array, performance.positions());
  const auto array_bytes = static_cast<double>(fs::file_size(array));
  add("read npy", array_bytes, [array] { read_npy_frames(array); });
  add("write npy", array_bytes,
      [array, &performance] { write_npy_frames(array, performance.positions()); });
  return measured(cases, settings.quick);
}

}  // namespace mimetra::bench
