#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/architecture/dependency_rules.h"
#include "tests/test_folders.h"

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

bool is_list(const fs::path& file) {
  return file.filename() == "CMakeLists.txt";
}

/// Files of the folders `tops` that `wanted` selects, and what they hold.
template <typename Wanted>
test::Tree files_of(const std::vector<std::string>& tops, Wanted wanted) {
  test::Tree files;
  const fs::path project = test::source_folder();
  for (const std::string& top : tops) {
    for (const fs::path& file : fs::recursive_directory_iterator(project / top)) {
      if (wanted(file)) files[file.lexically_relative(project)] = content(file);
    }
  }
  return files;
}

const std::vector<std::string> kFolders = {"geodesic", "toolkit", "fitting", "plugins", "samples"};

const test::Tree& sources() {
  static const test::Tree files = files_of(kFolders, is_source);
  return files;
}

const test::Tree& sources_and_tests() {
  static const test::Tree files = [] {
    std::vector<std::string> tops = kFolders;
    tops.push_back("tests");
    return files_of(tops, is_source);
  }();
  return files;
}

TEST(Architecture, IsKeptByEveryIncludeOfTheProject) {
  for (const auto& [file, text] : sources()) EXPECT_THAT(include_errors(file, text), IsEmpty());
}

TEST(Architecture, IsKeptByEveryLibraryOfTheProject) {
  for (const auto& [file, text] : files_of(kFolders, is_list)) {
    EXPECT_THAT(link_errors(file, text), IsEmpty());
  }
}

TEST(Architecture, IsTestedOnTheFilesThatExist) {
  EXPECT_TRUE(sources().contains("toolkit/mesh/openmesh.h"));
  EXPECT_TRUE(sources().contains("toolkit/mesh/types.h"));
  EXPECT_TRUE(sources_and_tests().contains("tests/architecture/architecture_test.cpp"));
}

TEST(Architecture, NamesEveryIncludedFileByItsPathFromTheRoot) {
  EXPECT_THAT(test::path_errors(sources_and_tests()), IsEmpty());
}

TEST(Architecture, IncludesNoPrivateHeaderOfAnotherFolder) {
  EXPECT_THAT(test::private_header_errors(sources(), files_of(kFolders, is_list)), IsEmpty());
}

TEST(Architecture, HasOneHeaderForAllAlgorithmsWithAPage) {
  const std::set<std::string> others = {"index", "landmark_fitter"};
  const std::string all = content(test::source_folder() / "all.h");
  for (const auto& page : fs::directory_iterator(test::source_folder() / "docs/algorithms")) {
    const std::string name = page.path().stem();
    if (others.contains(name)) continue;
    EXPECT_THAT(all, HasSubstr("/" + name + ".h\""));
  }
}

TEST(Architecture, HasNoTwoHeadersOfOneName) {
  EXPECT_THAT(test::name_errors(sources_and_tests()), IsEmpty());
}

TEST(Architecture, HasNoCircleOfFiles) {
  EXPECT_THAT(test::circles(sources_and_tests()), IsEmpty());
}

TEST(Architecture, HasNoCircles) {
  std::set<std::string> earlier;
  for (const test::FolderRule& rule : folder_rules()) {
    for (const std::string& folder : rule.folders) {
      EXPECT_TRUE(earlier.contains(folder)) << rule.path << " uses " << folder;
    }
    earlier.insert(rule.name);
  }
}

TEST(IncludeRule, NamesFileLineAndReason) {
  EXPECT_THAT(
      include_errors("toolkit/model/a.cpp", "\n#include \"toolkit/io/mesh_file.h\"\n"),
      ElementsAre("toolkit/model/a.cpp:2: toolkit/io/mesh_file.h: toolkit/model may not use "
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
                    Include{"geodesic/a.cpp", "#include \"toolkit/mesh/surface.h\""},
                    Include{"toolkit/mesh/openmesh.h", "#include <OpenMesh/Core/Mesh/x.hh>"},
                    Include{"toolkit/mesh/surface.h", "#include <OpenMesh/Core/Mesh/x.hh>"},
                    Include{"toolkit/mesh/a.cpp", "#include \"toolkit/mesh/tri_mesh.h\""},
                    Include{"toolkit/io/json_text.h", "#include <nlohmann/json_fwd.hpp>"},
                    Include{"toolkit/io/a.cpp", "#include <zip.h>"},
                    Include{"toolkit/io/a.cpp", "#include \"toolkit/io/fast_float.h\""},
                    Include{"toolkit/io/a.cpp", "#include <vector>"},
                    Include{"toolkit/io/a.cpp", "#include <sys/mman.h>"},
                    Include{"toolkit/io/a.cpp", "// #include <CGAL/Kernel.h>"},
                    Include{"toolkit/vtk/a.cpp", "#include <vtkPolyData.h>"},
                    Include{"toolkit/vtk/a.cpp", "#include \"toolkit/regions/regions.h\""},
                    Include{"toolkit/pipeline/a.cpp", "#include \"toolkit/transfer/x.h\""},
                    Include{"toolkit/operations/a.cpp", "#include \"toolkit/pipeline/x.h\""},
                    Include{"samples/a.cpp", "#include <mimetra/toolkit/report/x.h>"},
                    Include{"samples/head/a.cpp", "#include \"toolkit/transfer/x.h\""},
                    Include{"samples/a.cpp", "#include <OpenMesh/Core/IO/MeshIO.hh>"},
                    Include{"fitting/a.cpp", "#include <dlib/image_processing.h>"}));

class ForbiddenInclude : public testing::TestWithParam<Include> {};

TEST_P(ForbiddenInclude, IsAnError) {
  EXPECT_EQ(include_errors(GetParam().file, GetParam().line).size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(
    IncludeRule, ForbiddenInclude,
    testing::Values(Include{"geodesic/a.cpp", "#include \"toolkit/splocs/x.h\""},
                    Include{"geodesic/a.cpp", "#include <mimetra/toolkit/splocs/x.h>"},
                    Include{"toolkit/mesh/a.cpp", "#include \"geodesic/x.h\""},
                    Include{"geodesic/a.cpp", "#include \"../toolkit/mesh/tri_mesh.h\""},
                    Include{"geodesic/a.h", "  # include <CGAL/Kernel.h>"},
                    Include{"toolkit/mesh/a.h", "#include <OpenMesh/Core/Mesh/x.hh>"},
                    Include{"toolkit/mesh/a.cpp", "#include <CGAL/Kernel.h>"},
                    Include{"toolkit/io/a.cpp", "#include <hdf5.h>"},
                    Include{"toolkit/model/a.cpp", "#include \"nlohmann/json.hpp\""},
                    Include{"toolkit/operations/a.cpp", "#include \"toolkit/vtk/vtp_series.h\""},
                    Include{"toolkit/operations/a.cpp", "#include <vtkPolyData.h>"},
                    Include{"toolkit/operations/a.cpp", "#include \"vtkPolyData.h\""},
                    Include{"toolkit/operations/a.cpp", "#include \"samples/head/head.h\""},
                    Include{"toolkit/operations/a.cpp", "#include <spdlog/spdlog.h>"},
                    Include{"toolkit/io/a.h", "#include <nlohmann/json.hpp>"},
                    Include{"toolkit/io/a.cpp", "#include \"toolkit/transfer/x.h\""},
                    Include{"toolkit/pipeline/a.cpp", "#include \"toolkit/io/mesh_file.h\""},
                    Include{"toolkit/pipeline/a.cpp", "#include \"toolkit/operations/x.h\""},
                    Include{"toolkit/pipeline/a.cpp", "#include <nlohmann/json.hpp>"},
                    Include{"toolkit/io/a.cpp", "#include \"toolkit/pipeline/x.h\""},
                    Include{"toolkit/vtk/a.h", "#include <vtkPolyData.h>"},
                    Include{"toolkit/vtk/a.cpp", "#include <EGL/egl.h>"},
                    Include{"toolkit/vtk/a.cpp", "#include <vtkRenderWindow.h>"},
                    Include{"plugins/paraview/a.cpp", "#include <toolkit/report/report.h>"},
                    Include{"toolkit/vtk/a.cpp", "#include \"toolkit/drawing/picture.h\""},
                    Include{"toolkit/pictures/a.cpp", "#include \"toolkit/report/x.h\""},
                    Include{"toolkit/cli/a.cpp", "#include <dlib/image_io.h>"},
                    Include{"toolkit/splocs/a.cpp", "#include <gtest/gtest.h>"},
                    Include{"toolkit/regions/a.cpp", "#include <unheard/of.h>"},
                    Include{"plugins/c/a.cpp", "#include \"toolkit/vtk/vtp_series.h\""},
                    Include{"samples/plugin/a.cpp", "#include \"toolkit/operations/operation.h\""},
                    Include{"samples/head/a.cpp", "#include \"plugins/c/mimetra.h\""},
                    Include{"toolkit/stray.cpp", ""}));

TEST(PathRule, KnowsAFileOnlyByItsPathFromTheRoot) {
  const std::string own = "#include \"b.h\"\n#include \"toolkit/mesh/b.h\"\n#include <vector>\n";
  EXPECT_THAT(test::path_errors({{"toolkit/mesh/a.cpp", own}, {"toolkit/mesh/b.h", ""}}),
              ElementsAre("toolkit/mesh/a.cpp:1: b.h: is not a file of the tree"));
}

TEST(PathRule, TakesNoAnglesForAFileOfTheTree) {
  EXPECT_THAT(test::path_errors({{"tests/mesh/a.cpp", "#include <toolkit/mesh/b.h>\n"},
                                 {"toolkit/mesh/b.h", ""}}),
              ElementsAre(HasSubstr("write \"toolkit/mesh/b.h\"")));
}

TEST(PathRule, LeavesTheTreesPathToTheTree) {
  EXPECT_THAT(
      test::path_errors({{"samples/a.cpp", "#include \"geodesic/b.h\"\n"}, {"geodesic/b.h", ""}}),
      ElementsAre(HasSubstr("write <mimetra/geodesic/b.h>")));
}

TEST(PathRule, LeavesTheInstalledPathToUsers) {
  const test::Tree header = {{"toolkit/mesh/b.h", ""}};
  const std::string installed = "#include <mimetra/toolkit/mesh/b.h>\n";
  for (const char* user : {"samples/a.cpp", "samples/plugin/a.c", "tests/package/consumer/a.cpp"}) {
    test::Tree tree = header;
    tree[user] = installed;
    EXPECT_THAT(test::path_errors(tree), IsEmpty());
  }
  test::Tree tree = header;
  tree["tests/mesh/a.cpp"] = installed;
  EXPECT_THAT(test::path_errors(tree), ElementsAre(HasSubstr("write \"toolkit/mesh/b.h\"")));
}

TEST(PrivateHeaderRule, HoldsAcrossFoldersOnly) {
  const std::string both = "#include \"geodesic/a.h\"\n#include \"geodesic/b.h\"\n";
  const test::Tree lists = {{"geodesic/CMakeLists.txt", "SOURCES a.cpp\n  HEADERS a.h\n  USES x"}};
  EXPECT_THAT(test::private_header_errors({{"geodesic/c.cpp", both}}, lists), IsEmpty());
  EXPECT_THAT(test::private_header_errors({{"toolkit/mesh/c.cpp", both}}, lists),
              ElementsAre(HasSubstr("toolkit/mesh/c.cpp:2: geodesic/b.h: is private")));
}

TEST(NameRule, FindsTwoHeadersOfOneName) {
  EXPECT_THAT(test::name_errors({{"fitting/image.h", ""}, {"toolkit/io/image.h", ""}}),
              ElementsAre("toolkit/io/image.h: has the name of fitting/image.h"));
}

TEST(CircleRule, TakesAHeaderAndItsSourceForOne) {
  const test::Tree tree = {
      {"geodesic/a.h", ""},
      {"geodesic/a.cpp", "#include \"geodesic/a.h\"\n#include \"geodesic/b.h\""},
      {"geodesic/b.h", ""},
      {"geodesic/b.cpp", "#include \"geodesic/c.h\""},
      {"geodesic/c.h", "#include \"geodesic/a.h\""}};
  EXPECT_THAT(test::circles(tree),
              ElementsAre("geodesic/a -> geodesic/b -> geodesic/c -> geodesic/a"));
  test::Tree straight = tree;
  straight["geodesic/c.h"] = "";
  EXPECT_THAT(test::circles(straight), IsEmpty());
}

TEST(LinkRule, NamesFileLineAndReason) {
  EXPECT_THAT(link_errors("toolkit/io/CMakeLists.txt", "mimetra_library(io\n  USES mimetra::vtk)"),
              ElementsAre(HasSubstr("toolkit/io/CMakeLists.txt:2: mimetra::vtk: toolkit/io may not "
                                    "use vtk")));
}

TEST(LinkRule, FindsThirdPartiesOfOtherFolders) {
  EXPECT_THAT(link_errors("toolkit/model/CMakeLists.txt", "PRIVATE VTK::IOXML OpenMeshCore"),
              ElementsAre(HasSubstr("may not use VTK"), HasSubstr("may not use OpenMesh")));
}

TEST(LinkRule, LooksIntoGeneratorExpressions) {
  EXPECT_THAT(link_errors("toolkit/io/CMakeLists.txt",
                          "PRIVATE $<BUILD_INTERFACE:mimetra::vtk> mimetra_report "
                          "$<LINK_ONLY:dlib::dlib>"),
              ElementsAre(HasSubstr("may not use vtk"), HasSubstr("may not use report"),
                          HasSubstr("may not use dlib")));
}

TEST(LinkRule, AllowsWhatTheTableAllows) {
  EXPECT_THAT(link_errors("toolkit/io/CMakeLists.txt",
                          "mimetra_library(io USES mimetra::regions PRIVATE libzip::zip)"),
              IsEmpty());
}

TEST(LinkRule, LeavesCommentsAlone) {
  EXPECT_THAT(link_errors("toolkit/io/CMakeLists.txt", "# never mimetra::vtk"), IsEmpty());
}

}  // namespace
}  // namespace mimetra
