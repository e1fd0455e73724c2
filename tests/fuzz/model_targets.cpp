#include <algorithm>
#include <cstdint>
#include <initializer_list>

#include <meshoptimizer.h>

#include "fitting/image_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/values.h"
#include "toolkit/formats/eos.h"
#include "toolkit/formats/gltf/gltf_values.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/bytes.h"
#include "toolkit/io/live_link.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/io/whole_file.h"

#ifdef MIMETRA_HAS_DRACO
#include "tests/io/draco_octahedron.h"
#endif

namespace mimetra::fuzz {

namespace {

/// The first byte, or 0.
std::size_t first_byte(const std::string& bytes) {
  return bytes.empty() ? 0 : static_cast<unsigned char>(bytes[0]);
}

void write_grid(const fs::path& file) {
  write_mesh(file, grid());
}

/// The quick reader of the frames after the first, which finds its places in that one.
Target frame_target(const std::string& extension) {
  return {"frame_" + extension,
          "frame." + extension,
          [extension](const fs::path& file) {
            static const MeshFileReader first = [&] {
              const fs::path sound = file.parent_path() / ("first." + extension);
              write_grid(sound);
              return MeshFileReader(sound);
            }();
            first.read(file);
          },
          {write_grid}};
}

/// Both files of an eos model: the length of the first in numbers stands before them.
void read_eos_pair(const fs::path& file) {
  const std::string bytes = read_file(file);
  const std::string pair = bytes.substr(bytes.empty() ? 0 : 1);
  const std::size_t shape = std::min(first_byte(bytes) * 4, pair.size());
  const fs::path first = file.parent_path() / "sfm_shape_1.bin";
  const fs::path second = file.parent_path() / "expression_blendshapes_1.bin";
  write_bytes(first, pair.substr(0, shape));
  write_bytes(second, pair.substr(shape));
  is_eos_shape(first);
  read_eos(first, second);
}

/// A triangle with an identity, without colours and texture, and one expression.
void write_eos_pair(const fs::path& file) {
  std::string shape, expressions;
  const auto add = [](std::string& bytes, std::initializer_list<std::int32_t> numbers) {
    for (const std::int32_t number : numbers) append_little_endian(bytes, number);
  };
  const auto add_column = [&](std::string& bytes, int rows) {
    add(bytes, {rows, 1});
    for (int row = 0; row < rows; ++row) append_little_endian(bytes, 0.5F * float(row));
  };
  add(shape, {1});
  for (const int rows : {9, 9, 1}) add_column(shape, rows);
  add(shape, {1, 0, 0, 1, 2});
  for (int color = 0; color < 3; ++color) add_column(shape, 0);
  add(shape, {0, 0, 0, 0});
  add(expressions, {1, 0, 4, 0});
  expressions += "jaw_";
  add_column(expressions, 9);
  write_bytes(file, std::string(1, static_cast<char>(shape.size() / 4)) + shape + expressions);
}

/// A view's mode and filter, its stride and its count stand before its bytes.
void read_meshopt(const fs::path& file) {
  const std::string bytes = read_file(file);
  if (bytes.size() < 4) return;
  const auto number = [&bytes](std::size_t i) { return first_byte(bytes.substr(i)); };
  const GltfCompression how{.buffer = 0,
                            .offset = 0,
                            .bytes = bytes.size() - 4,
                            .stride = number(1),
                            .count = number(2) + 256 * number(3),
                            .mode = GltfCompression::Mode(number(0) % 3),
                            .filter = GltfCompression::Filter(number(0) / 3 % 4)};
  decompressed("a.glb", "view 0", how, std::string_view(bytes).substr(4));
}

void write_meshopt_points(const fs::path& file) {
  const Positions& points = grid().positions;
  const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> values = points.cast<float>();
  const auto count = static_cast<std::size_t>(points.rows());
  std::string bytes(meshopt_encodeVertexBufferBound(count, 12), '\0');
  bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                          bytes.size(), values.data(), count, 12));
  write_bytes(file, std::string("\x00\x0c\x09\x00", 4) + bytes);
}

void write_meshopt_faces(const fs::path& file) {
  const Triangles& triangles = grid().connectivity.triangles;
  const std::vector<unsigned> corners(triangles.data(), triangles.data() + triangles.size());
  std::string bytes(meshopt_encodeIndexBufferBound(corners.size(), 9), '\0');
  bytes.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                         bytes.size(), corners.data(), corners.size()));
  write_bytes(file, std::string("\x01\x04\x18\x00", 4) + bytes);
}

/// A grey block of 8 x 8 pixels, whose only codes are "no change" and "end of block".
std::string smallest_jpeg() {
  const std::string codes = '\1' + std::string(16, '\0');
  const auto bytes = [](std::initializer_list<int> values) {
    return std::string(values.begin(), values.end());
  };
  return bytes({0xff, 0xd8, 0xff, 0xdb, 0, 67, 0}) + std::string(64, '\1') +
         bytes({0xff, 0xc0, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0}) + bytes({0xff, 0xc4, 0, 20, 0}) +
         codes + bytes({0xff, 0xc4, 0, 20, 0x10}) + codes +
         bytes({0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0, 0x3f, 0xff, 0xd9});
}

/// A red pixel.
std::string smallest_png() {
  return std::string(
      "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\1\0\0\0\1\x08\2\0\0\0\x90wS\xde\0\0\0\x0cIDAT\x08\xd7"
      "c\xf8\xcf\xc0\0\0\3\1\1\0\x18\xdd\x8d\xb0\0\0\0\0IEND\xae\x42\x60\x82",
      69);
}

}  // namespace

std::vector<Target> model_targets() {
  std::vector<Target> targets = {
      frame_target("obj"),
      frame_target("ply"),
      {"mesh_library",
       "a.mtl",
       [](const fs::path& file) {
         const fs::path mesh = fs::path(file).replace_extension(".obj");
         write_bytes(mesh, "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl skin\nf 1 2 3\n");
         const SequenceRead read = read_sequence(mesh.string(), {}, Context().with_threads(1));
         write_sequence(read.sequence, file.parent_path() / "b" / "c.obj", {.overwrite = true}, {},
                        Context().with_threads(1));
       },
       {text("newmtl skin\nKd 1 0.5 0.5\nmap_Kd -s 1 1 1 skin.png\n")}},
      {"eos", "pair.bin", read_eos_pair, {write_eos_pair}},
      {"model_json",
       "model.json",
       [](const fs::path& file) {
         const fs::path folder = file.parent_path();
         fs::create_directories(folder / "targets");
         for (const char* mesh : {"neutral.ply", "targets/smile.ply"}) write_grid(folder / mesh);
         read_model(folder, Context().with_threads(1));
       },
       {text(R"({"neutral": "neutral.ply", "expressions": "targets"})")}},
      {"weights_csv",
       "w.csv",
       [](const fs::path& file) {
         const WeightTrack track = read_weights(file);
         weights_for(track, {"smile", "brow_L", "jawOpen"});
         if (has_live_link_names(track.names)) live_link_csv(track);
       },
       {[](const fs::path& file) {
          write_weights(file, std::get<ModelData>(value_of(DataKind::model)).performance, true);
        },
        text("Timecode,BlendshapeCount,JawOpen\n00:00:01:02.500,1,0.5\n00:00:01:03.500,1,0.25\n")}},
      {"weights_json",
       "w.json",
       [](const fs::path& file) {
         const std::vector<std::string> expressions = {"smile", "brow_L", "jawOpen"};
         WeightTrack track = read_weights(file);
         scale_weights("w.json", track, expressions, {});
         weights_for(track, expressions);
       },
       {text(R"([{"time": 0, "smile": 0.5}, {"time": 1, "smile": 0.25}])"),
        text(R"({"names": ["smile", "jawOpen"], "weights": [[0, 1], [0.5, 0]], "fps": 30})")}},
      {"meshopt", "view.bin", read_meshopt, {write_meshopt_points, write_meshopt_faces}},
      {"image",
       "a.png",
       [](const fs::path& file) { read_image(file); },
       {text(smallest_jpeg()), text(smallest_png())}}};
#ifdef MIMETRA_HAS_DRACO
  targets.push_back(
      {"draco",
       "view.bin",
       [](const fs::path& file) {
         decode_draco("a.glb", "mesh 0", {.view = 0, .positions = 0, .texture = 1},
                      read_file(file));
       },
       {text(test::draco_octahedron(true)), text(test::quantised_draco_octahedron())}});
#endif
  return targets;
}

}  // namespace mimetra::fuzz
