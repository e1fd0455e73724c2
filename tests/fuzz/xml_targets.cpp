#include "tests/fuzz/fuzz_target.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/operations/option_file.h"
#include "toolkit/vtk/vtp_header.h"
#include "toolkit/vtk/xml_elements.h"

namespace mimetra::fuzz {

namespace {

const Target kPvd({"pvd", "take.pvd",
                   [](const fs::path& file) { xml_elements("take.pvd", read_file(file)); },
                   [](const fs::path& file) {
                     write_bytes(file,
                                 "<?xml version=\"1.0\"?><!-- a --><VTKFile type=\"Collection\">"
                                 "<Collection><DataSet timestep=\"0\" file=\"a &amp; b.vtp\"/>"
                                 "</Collection></VTKFile>");
                   }});

/// What VTK is given is what passes here.
const Target kVtp(
    {"vtp", "mesh.vtp", [](const fs::path& file) { check_vtp_header("mesh.vtp", read_file(file)); },
     [](const fs::path& file) {
       write_bytes(file,
                   "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
                   "compressor=\"vtkZLibDataCompressor\"><PolyData><Piece NumberOfPoints=\"3\" "
                   "NumberOfPolys=\"1\"><Points><DataArray type=\"Float32\" "
                   "NumberOfComponents=\"3\" format=\"binary\">AQAAACAAAAAgAAAAEAAAAA==eJw="
                   "</DataArray></Points><Polys><DataArray type=\"Int32\" format=\"appended\" "
                   "offset=\"4\"/></Polys></Piece></PolyData><AppendedData "
                   "encoding=\"raw\">_12345678901234567890</AppendedData></VTKFile>");
     }});

/// The texts of options, one of each kind, as a --config file has them.
const Target kConfig(
    {"config", "c.json",
     [](const fs::path& file) {
       Parameters parameters(
           {{"k", ParameterKind::integer, std::int64_t{30}, "", "", 1, 1000},
            {"ks", ParameterKind::integer_list, std::vector<std::int64_t>{10}, ""},
            {"ridge", ParameterKind::number, 0.5, "", "", 0, 1},
            {"radius", ParameterKind::length, std::string("0.1"), "", "", 0, 1},
            {"full", ParameterKind::flag, false, ""},
            {"space", ParameterKind::choice, std::string("a"), "", "", {}, {}, {"a", "b"}},
            {"rest", ParameterKind::file, std::string(""), ""}});
       set_from_file(file.string(), parameters);
       parameters.length("radius");
       parameters.integer("k");
     },
     [](const fs::path& file) {
       write_bytes(file, R"({"k": 3, "ks": [10, 30], "ridge": 0.25, "radius": "12abs",)"
                         R"( "full": true, "space": "b", "rest": "a.ply"})");
     }});

}  // namespace

}  // namespace mimetra::fuzz
