#include "tests/fuzz/fuzz_target.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/regions_file.h"
#include "toolkit/io/weight_track.h"
#include "toolkit/io/whole_file.h"

namespace mimetra::fuzz {

namespace {

/// A target whose start is a text.
TargetDescription text_target(const std::string& name, const std::string& file,
                              const std::string& text,
                              std::function<void(const fs::path& file)> read) {
  return {name, file, std::move(read),
          [text](const fs::path& target) { write_bytes(target, text); }};
}

void read_region_set(const fs::path& file) {
  read_regions(file, 9, grid().connectivity.triangles);
}

Regions two_regions() {
  return regions_from_vertices(9, grid().connectivity.triangles, {{0, 1}, {4, 5}});
}

const Target kRegionsJson(text_target("regions_json", "r.json", regions_json(two_regions()),
                                      read_region_set));
const Target kRegionsCsv(text_target("regions_csv", "r.csv", regions_csv(two_regions()),
                                     read_region_set));
const Target kRegionsText(text_target("regions_txt", "r.txt", "3\n4\n5\n", read_region_set));

const Target kWeights(text_target("weights_csv", "w.csv",
                                  "time,smile,brow_L\n0,0.5,1\n0.04,0.25,\"0.5\"\n",
                                  [](const fs::path& file) {
                                    weights_for(read_weights(file), {"smile", "brow_L", "jaw"});
                                  }));

/// Whatever was read can be written, and be read again.
const Target kJson(
    text_target("json", "a.json", R"({"k": [1, 2.5, "x\u00e4"], "all": {"a": null}})",
                [](const fs::path& file) { parse_json("a.json", json_text(read_json(file), 1)); }));

const Target kFrameRange(text_target("frame_range", "range.txt", "2:90:3",
                                     [](const fs::path& file) {
                                       selected_frames(read_file(file), 100);
                                     }));

}  // namespace

}  // namespace mimetra::fuzz
