#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dependency_rules.h"
#include "test_folders.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using test::folder_rules;
using test::include_errors;
using test::link_errors;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool is_source(const fs::path& file) {
  static const std::set<std::string> extensions = {".h",  ".hh",  ".hpp", ".c",
                                                   ".cc", ".cpp", ".cxx", ".ipp"};
  return extensions.contains(file.extension().string());
}

/// Files of the project's folders that `wanted` selects, by their paths within the project.
template <typename Wanted>
std::vector<fs::path> project_files(Wanted wanted) {
  std::vector<fs::path> files;
  const fs::path project = test::source_folder();
  for (const char* top : {"geodesic", "toolkit", "fitting", "plugins", "samples"}) {
    if (!fs::exists(project / top)) continue;
    for (const fs::path& file : fs::recursive_directory_iterator(project / top)) {
      if (wanted(file)) files.push_back(file.lexically_relative(project));
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Architecture, IsKeptByEveryIncludeOfTheProject) {
  for (const fs::path& file : project_files(is_source)) {
    EXPECT_THAT(include_errors(file, content(test::source_folder() / file)), IsEmpty());
  }
}

TEST(Architecture, IsKeptByEveryLibraryOfTheProject) {
  const auto is_list = [](const fs::path& file) { return file.filename() == "CMakeLists.txt"; };
  for (const fs::path& file : project_files(is_list)) {
    EXPECT_THAT(link_errors(file, content(test::source_folder() / file)), IsEmpty());
  }
}

TEST(Architecture, IsTestedOnTheFilesThatExist) {
  const std::vector<fs::path> files = project_files(is_source);
  EXPECT_THAT(files, testing::Contains(fs::path("toolkit/mesh/openmesh.h")));
  EXPECT_THAT(files, testing::Contains(fs::path("geodesic/types.h")));
}

TEST(Architecture, HasNoCircles) {
  std::set<std::string> earlier;
  for (const test::FolderRule& rule : folder_rules()) {
    for (const std::string& folder : rule.folders) {
      EXPECT_TRUE(earlier.contains(folder)) << rule.path << " uses " << folder;
    }
    earlier.insert(rule.name());
  }
}

TEST(IncludeRule, NamesFileLineAndReason) {
  EXPECT_THAT(
      include_errors("toolkit/model/a.cpp", "\n#include <mimetra/io/mesh_file.h>\n"),
      ElementsAre("toolkit/model/a.cpp:2: mimetra/io/mesh_file.h: toolkit/model may not use "
                  "io (only mesh)"));
}

struct Include {
  const char* file;
  const char* line;
};

class AllowedInclude : public testing::TestWithParam<Include> {};

TEST_P(AllowedInclude, IsNoError) {
  EXPECT_THAT(include_errors(GetParam().file, GetParam().line), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    IncludeRule, AllowedInclude,
    testing::Values(Include{"geodesic/a.cpp", "#include <CGAL/Heat_method_3.h>"},
                    Include{"geodesic/a.h", "#include <Eigen/Core>"},
                    Include{"toolkit/mesh/openmesh.h", "#include <OpenMesh/Core/Mesh/x.hh>"},
                    Include{"toolkit/mesh/a.cpp", "#include <mimetra/mesh/tri_mesh.h>"},
                    Include{"toolkit/operations/a.h", "#include <nlohmann/json_fwd.hpp>"},
                    Include{"toolkit/io/a.cpp", "#include <hdf5.h>"},
                    Include{"toolkit/io/a.cpp", "#include \"fast_float.h\""},
                    Include{"toolkit/io/a.cpp", "#include <vector>"},
                    Include{"toolkit/io/a.cpp", "#include <sys/mman.h>"},
                    Include{"toolkit/io/a.cpp", "// #include <CGAL/Kernel.h>"},
                    Include{"toolkit/vtk/a.cpp", "#include <vtkPolyData.h>"},
                    Include{"toolkit/vtk/a.cpp", "#include <mimetra/regions/regions.h>"},
                    Include{"samples/head/a.cpp", "#include <mimetra/transfer/x.h>"},
                    Include{"samples/head/a.cpp", "#include <OpenMesh/Core/IO/MeshIO.hh>"},
                    Include{"fitting/a.cpp", "#include <dlib/image_processing.h>"}));

class ForbiddenInclude : public testing::TestWithParam<Include> {};

TEST_P(ForbiddenInclude, IsAnError) {
  EXPECT_EQ(include_errors(GetParam().file, GetParam().line).size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(
    IncludeRule, ForbiddenInclude,
    testing::Values(Include{"geodesic/a.cpp", "#include <mimetra/mesh/tri_mesh.h>"},
                    Include{"geodesic/a.cpp", "#include \"mimetra/mesh/tri_mesh.h\""},
                    Include{"geodesic/a.cpp", "#include \"../toolkit/mesh/tri_mesh.h\""},
                    Include{"geodesic/a.h", "  # include <CGAL/Kernel.h>"},
                    Include{"toolkit/mesh/a.h", "#include <OpenMesh/Core/Mesh/x.hh>"},
                    Include{"toolkit/mesh/a.cpp", "#include <CGAL/Kernel.h>"},
                    Include{"toolkit/mesh/a.cpp", "#include <hdf5.h>"},
                    Include{"toolkit/model/a.cpp", "#include \"nlohmann/json.hpp\""},
                    Include{"toolkit/operations/a.cpp", "#include <mimetra/vtk/vtp_series.h>"},
                    Include{"toolkit/operations/a.cpp", "#include <vtkPolyData.h>"},
                    Include{"toolkit/operations/a.cpp", "#include \"vtkPolyData.h\""},
                    Include{"toolkit/operations/a.cpp", "#include <mimetra/samples/head.h>"},
                    Include{"toolkit/operations/a.cpp", "#include <spdlog/spdlog.h>"},
                    Include{"toolkit/io/a.h", "#include <nlohmann/json.hpp>"},
                    Include{"toolkit/io/a.cpp", "#include <mimetra/transfer/x.h>"},
                    Include{"toolkit/vtk/a.h", "#include <vtkPolyData.h>"},
                    Include{"toolkit/cli/a.cpp", "#include <dlib/image_io.h>"},
                    Include{"toolkit/splocs/a.cpp", "#include <gtest/gtest.h>"},
                    Include{"toolkit/regions/a.cpp", "#include <unheard/of.h>"},
                    Include{"plugins/c/a.cpp", "#include <mimetra/vtk/vtp_series.h>"},
                    Include{"samples/plugin/a.cpp", "#include <mimetra/operations/operation.h>"},
                    Include{"samples/head/a.cpp", "#include <mimetra/c/mimetra.h>"},
                    Include{"toolkit/stray.cpp", ""}));

TEST(LinkRule, NamesFileLineAndReason) {
  EXPECT_THAT(link_errors("toolkit/io/CMakeLists.txt", "mimetra_library(io\n  USES mimetra::vtk)"),
              ElementsAre(HasSubstr("toolkit/io/CMakeLists.txt:2: mimetra::vtk: toolkit/io may not "
                                    "use vtk")));
}

TEST(LinkRule, FindsThirdPartiesOfOtherFolders) {
  EXPECT_THAT(link_errors("toolkit/model/CMakeLists.txt", "PRIVATE VTK::IOXML OpenMeshCore"),
              ElementsAre(HasSubstr("may not use VTK"), HasSubstr("may not use OpenMesh")));
}

TEST(LinkRule, AllowsWhatTheTableAllows) {
  EXPECT_THAT(link_errors("toolkit/io/CMakeLists.txt",
                          "mimetra_library(io USES mimetra::regions PRIVATE ${HDF5_C_LIBRARIES})"),
              IsEmpty());
}

TEST(LinkRule, LeavesCommentsAlone) {
  EXPECT_THAT(link_errors("toolkit/io/CMakeLists.txt", "# never mimetra::vtk"), IsEmpty());
}

}  // namespace
}  // namespace mimetra
