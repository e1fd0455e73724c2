#include <limits>

#include "tests/cli/bad_input.h"
#include "toolkit/formats/hdf5/hdf5_image.h"

/// Sequences in HDF5.
namespace mimetra::test {

namespace {

/// What a file holds, 2 frames of the square unless changed.
struct Parts {
  std::vector<double> verts;
  std::vector<std::uint64_t> shape = {2, 4, 3};
  std::vector<int> tris = {0, 1, 2, 0, 2, 3};
  std::vector<double> times;

  Parts() {
    for (const double lift : {0.0, 0.1}) {
      for (const auto& point : square(lift).vertices) {
        verts.insert(verts.end(), point.begin(), point.end());
      }
    }
  }

  std::string bytes() const {
    Hdf5Image image;
    Hdf5Array positions = Hdf5Array::of(std::span<const double>(verts));
    positions.shape = shape;
    image.add("verts", std::move(positions));
    if (!tris.empty()) {
      Hdf5Array triangles = Hdf5Array::of(std::span<const int>(tris));
      triangles.shape = {tris.size() / 3, 3};
      image.add("tris", std::move(triangles));
    }
    if (!times.empty()) image.add("times", Hdf5Array::of(std::span<const double>(times)));
    return image.image();
  }
};

}  // namespace

std::vector<BadInput> hdf5_cases() {
  std::vector<BadInput> all;
  const auto add = [&all](const std::string& kind, std::function<void(const fs::path&)> make,
                          int code, std::vector<std::string> says) {
    says.push_back(code == 0 ? "frames" : "s.h5");
    add_case(all, kind, "hdf5", std::move(make), "info s.h5 --json", code, std::move(says));
  };
  const auto changed = [](const std::function<void(Parts&)>& change) {
    Parts parts;
    change(parts);
    return file("s.h5", parts.bytes());
  };
  const std::string good = Parts().bytes();
  add("whole", file("s.h5", good), 0, {});
  add("missing", {}, 3, {"no such file"});
  add("empty", file("s.h5", ""), 3, {"is not an HDF5 file"});
  add("other_type", file("s.h5", bytes_of(square(), "ply")), 3, {"is not an HDF5 file"});
  add("truncated", file("s.h5", good.substr(0, good.size() / 2)), 3, {"truncated"});
  add("truncated_at_the_end", file("s.h5", good.substr(0, good.size() - 1)), 3, {"truncated"});
  add("a_billion_frames", changed([](Parts& p) { p.shape[0] = 1000000000; }), 3,
      {"'verts' claims more numbers than the file holds"});
  add("no_frames", changed([](Parts& p) {
        p.shape[0] = 0;
        p.verts.clear();
      }),
      3, {"'verts' has 0 frames"});
  add("two_coordinates", changed([](Parts& p) {
        p.shape = {3, 4, 2};
      }),
      3, {"3 x 4 x 2", "expected frames x vertices x 3"});
  add("not_a_number",
      changed([](Parts& p) { p.verts[14] = std::numeric_limits<double>::quiet_NaN(); }), 3,
      {"frame 1: vertex 0"});
  add("infinity", changed([](Parts& p) { p.verts[14] = std::numeric_limits<double>::infinity(); }),
      3, {"frame 1: vertex 0"});
  add("index_out_of_range", changed([](Parts& p) { p.tris[4] = 4; }), 3,
      {"'tris' holds 4, expected 0 to 3"});
  add("negative_index", changed([](Parts& p) { p.tris[4] = -1; }), 3,
      {"'tris' holds -1, expected 0 to 3"});
  add("falling_times", changed([](Parts& p) { p.times = {1, 0.5}; }), 3, {"frame 1", "rise"});
  add("other_number_of_times", changed([](Parts& p) {
        p.times = {1, 2, 3};
      }),
      3, {"'times' is 3, expected 2"});
  add("without_faces", changed([](Parts& p) { p.tris.clear(); }), 3, {"--topology"});
  add("a_folder", [](const fs::path& folder) { fs::create_directory(folder / "s.h5"); }, 3,
      {"holds no PLY, OBJ, OFF, STL or OM file"});
  return all;
}

}  // namespace mimetra::test
