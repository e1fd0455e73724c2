#include "tests/cli/bad_input.h"

/// Region sets for a mesh of 225 vertices.
namespace mimetra::test {

namespace {

std::string numbers(int count, const std::string& number) {
  std::string text;
  for (int i = 0; i < count; ++i) text += number + '\n';
  return text;
}

/// The field `roi` on points that are all one place: only the field is read.
std::string vtp(int points, const std::string& field, const std::string& value) {
  const std::string count = std::to_string(points);
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
         "byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"" +
         count +
         "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">"
         "<PointData><DataArray type=\"Float32\" Name=\"" +
         field + "\" format=\"ascii\">\n" + numbers(points, value) +
         "</DataArray></PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
         "format=\"ascii\">\n" +
         numbers(points, "0 0 0") + "</DataArray></Points></Piece></PolyData></VTKFile>\n";
}

class RegionCases {
 public:
  void add(const std::string& extension, const std::string& kind, const std::string& bytes,
           int code, std::vector<std::string> says) {
    add(extension, kind, file("r." + extension, bytes), code, std::move(says));
  }
  void add(const std::string& extension, const std::string& kind,
           std::function<void(const fs::path&)> make, int code, std::vector<std::string> says) {
    const std::string name = "r." + extension;
    if (code != 0) says.push_back(name);
    add_case(all, kind, "regions_" + extension, std::move(make),
             "transfer head --weights take.csv head --regions " + name + " -o x.npy --json", code,
             std::move(says));
  }
  std::vector<BadInput> all;
};

void add_json(RegionCases& cases) {
  const auto list = [](const std::string& vertices) {
    return "{\"regions\": [{\"vertices\": " + vertices + "}]}";
  };
  cases.add("json", "other_type", "v 0 0 0\n", 3, {"expected {\"regions\""});
  cases.add("json", "truncated", "{\"regions\": [{\"vert", 3, {"expected {\"regions\""});
  cases.add("json", "no_region", "{\"regions\": []}", 3, {"holds no region"});
  cases.add("json", "empty_region", list("[]"), 4, {"no triangle"});
  cases.add("json", "index_out_of_range", list("[3, 225]"), 4, {"vertex 225", "0 to 224"});
  cases.add("json", "negative_index", list("[3, -1]"), 4, {"vertex -1", "0 to 224"});
  cases.add("json", "not_a_number", list("[3, null]"), 3, {"expected a vertex index, found null"});
  cases.add("json", "other_mesh", R"({"mesh_vertices": 99, "regions": [{"vertices": [3]}]})", 4,
            {"99 vertices, expected 225"});
  cases.add("json", "windows_lines_and_bom", "\xEF\xBB\xBF" + list("[112, 113,\r\n 127]"), 0,
            {"\"targets\""});
}

void add_text(RegionCases& cases) {
  cases.add("csv", "other_type", bytes_of(square(), "stl_binary"), 3, {"vertex,region"});
  cases.add("csv", "ragged_rows", "vertex,region\n3\n", 3, {"line 2", "a region"});
  cases.add("csv", "names_only", "vertex,region\n", 3, {"holds no region"});
  cases.add("csv", "index_out_of_range", "vertex,region\n225,0\n", 4, {"vertex 225"});
  cases.add("csv", "negative_index", "vertex,region\n-1,0\n", 4, {"vertex -1"});
  cases.add("csv", "decimal_commas", "vertex,region\n3,0,5\n", 3, {"line 2", "two columns"});
  cases.add("csv", "windows_lines_and_bom",
            "\xEF\xBB\xBFvertex,region\r\n112,0\r\n113,0\r\n127,1\r\n", 0, {"\"targets\""});
  cases.add("txt", "other_type", "\x89PNG\r\n", 3, {"line 1"});
  cases.add("txt", "index_out_of_range", "3\n225\n", 4, {"vertex 225"});
  cases.add("txt", "negative_index", "3\n-1\n", 4, {"vertex -1"});
  cases.add("txt", "not_a_number", "3\nnan\n", 3, {"line 2", "'nan'"});
  cases.add("txt", "mask_of_other_count", numbers(224, "1"), 4, {"224 vertices, expected 225"});
  cases.add("txt", "all_zero", numbers(225, "0"), 4, {"no triangle"});
  cases.add("txt", "windows_lines_and_bom",
            "\xEF\xBB\xBF"
            "112\r\n113\r\n127\r\n",
            0, {"\"targets\""});
}

void add_vtp(RegionCases& cases) {
  const std::string whole = vtp(225, "roi", "1");
  cases.add("vtp", "whole", whole, 0, {"\"targets\""});
  cases.add("vtp", "other_type", bytes_of(square(), "ply"), 3, {});
  cases.add("vtp", "truncated", whole.substr(0, whole.size() / 2), 3, {"truncated"});
  cases.add("vtp", "other_vertex_count", vtp(224, "roi", "1"), 4, {"224 vertices, expected 225"});
  cases.add("vtp", "without_the_field", vtp(225, "mask", "1"), 3, {"no field 'roi'", "mask"});
  cases.add("vtp", "not_a_number", vtp(225, "roi", "nan"), 3, {"roi", "vertex 0"});
  cases.add("vtp", "all_zero", vtp(225, "roi", "0"), 4, {"no triangle"});
}

/// What --only and --without name; the file is a list of vertices.
void add_places(RegionCases& cases) {
  const auto add = [&cases](const std::string& kind, const std::string& options, int code,
                            std::vector<std::string> says) {
    add_case(cases.all, kind, "place", file("set.txt", "225\n"),
             "transfer head --weights take.csv head -o x.npy " + options, code, std::move(says));
  };
  add("unknown_component", "--only component:7", 4, {"component '7'", "there are 0"});
  add("unknown_group", "--without group:lips", 4, {"group 'lips'", "has none"});
  add("index_out_of_range", "--only set.txt", 4, {"set.txt", "vertex 225", "0 to 224"});
  add("nowhere", "--without component:0", 4, {"--only, --without", "no vertex is left"});
  add("without_regions", "--only component:0 --full", 2, {"--only", "--full"});
}

}  // namespace

std::vector<BadInput> region_cases() {
  RegionCases cases;
  add_places(cases);
  for (const std::string extension : {"json", "csv", "txt", "vtp"}) {
    cases.add(extension, "missing", std::function<void(const fs::path&)>(), 3, {"no such file"});
    cases.add(extension, "empty", "", 3, {});
  }
  add_json(cases);
  add_text(cases);
  add_vtp(cases);
  add_case(cases.all, "unknown_format", "regions_xml", file("r.xml", "<r/>"),
           "transfer head --weights take.csv head --regions r.xml -o x", 2,
           {"r.xml", ".json", ".csv", ".txt", ".vtp"});
  return cases.all;
}

}  // namespace mimetra::test
