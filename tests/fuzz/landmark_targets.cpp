#include "fitting/image_codec.h"
#include "fitting/landmark_file.h"
#include "fitting/landmark_mapping.h"
#include "tests/fuzz/fuzz_target.h"
#include "toolkit/io/whole_file.h"

namespace mimetra::fuzz {

namespace {

TargetDescription landmark_target(const std::string& extension, const std::string& text) {
  return {"landmarks_" + extension, "l." + extension,
          [](const fs::path& file) { read_landmarks(file); },
          [text](const fs::path& file) { write_bytes(file, text); }};
}

const Target kPts(landmark_target("pts", "version: 1\nn_points: 3\n{\n1 2\n3.5 4\n5 6e1\n}\n"));
const Target kCsv(landmark_target("csv", "time,x0,y0,x1,y1\n0,1,2,3,4\n0.04,1,2,3,4\n"));
const Target kJson(landmark_target(
    "json", R"({"names": ["a", "b"], "frames": [{"time": 0, "points": [[1, 2], null]}]})"));

const Target kMapping({"landmark_mapping", "ibug_to_m.txt",
                       [](const fs::path& file) { read_landmark_mapping(file); },
                       [](const fs::path& file) {
                         write_bytes(file, "# iBUG\n[landmark_mappings]\n9 = 33\n31 = 114\n");
                       }});

const Target kImage({"image_header", "a.jpg",
                     [](const fs::path& file) { checked_image_header("a.jpg", read_file(file)); },
                     [](const fs::path& file) {
                       const std::string start = "\xff\xd8\xff\xc0";
                       write_bytes(file, start +
                                             std::string("\0\x0b\x08\0\x10\0\x10\x01\x01\x11", 10) +
                                             std::string("\0\xff\xd9", 3));
                     }});

}  // namespace

}  // namespace mimetra::fuzz
