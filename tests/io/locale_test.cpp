// A decimal comma in the locale of a host changes nothing in files.

#include <clocale>
#include <locale>

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// Of C++'s streams always, of C's functions where the machine has such a locale.
class DecimalCommas : public testing::Test {
 protected:
  DecimalCommas()
      : streams_(std::locale::global(std::locale(std::locale::classic(), new DecimalComma))),
        functions_(std::setlocale(LC_NUMERIC, nullptr)) {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8"}) {
      if (std::setlocale(LC_NUMERIC, name)) break;
    }
  }
  ~DecimalCommas() override {
    std::locale::global(streams_);
    std::setlocale(LC_NUMERIC, functions_.c_str());
  }

  test::TemporaryFolder folder_;

 private:
  std::locale streams_;
  std::string functions_;
};

TEST_F(DecimalCommas, ChangeNoMeshFile) {
  TriMesh mesh{Positions(3, 3),
               Connectivity::from_triangles(3, (Triangles(1, 3) << 0, 1, 2).finished())};
  mesh.positions << 0.5, 1234567.25, -1e-7, 1, 0, 0, 0, 1, 0;
  for (const char* name : {"a.obj", "a.ply", "a.off"}) {
    write_mesh(folder_ / name, mesh, {.double_precision = true});
    EXPECT_EQ(read_mesh(folder_ / name).positions, mesh.positions) << name;
  }
  EXPECT_NE(read_file(folder_ / "a.obj").find("v 0.5 1234567.25 -1e-07\n"), std::string::npos);
}

TEST_F(DecimalCommas, ChangeNoTrackOfWeights) {
  WeightTrack track;
  track.names = {"jawOpen"};
  track.times = Eigen::Vector2d(0, 1234.5);
  track.weights = Eigen::Vector2d(0.25, 0.5);
  write_weights(folder_ / "take.csv", track, false);
  const WeightTrack read = read_weights(folder_ / "take.csv");
  EXPECT_EQ(read.times, track.times);
  EXPECT_EQ(read.weights, track.weights);
}

TEST_F(DecimalCommas, ChangeNoNumberThatPeopleRead) {
  EXPECT_EQ(readable(0.5), "0.5");
  EXPECT_EQ(fixed(1234.5, 1), "1234.5");
}

TEST_F(DecimalCommas, ChangeNoNumberBeyondDouble) {
  const std::string path = "a.obj";
  const TextCursor cursor(path, "", {});
  for (const char* large : {"1.5e400", "1e+99999999999999999999", "0.001e400"}) {
    EXPECT_EQ(cursor.number(large, "x"), std::numeric_limits<double>::infinity()) << large;
    EXPECT_EQ(cursor.number(std::string("-") + large, "x"),
              -std::numeric_limits<double>::infinity());
  }
  const std::string zeros(400, '0');
  for (const std::string& small :
       {std::string("1.5e-400"), "0." + zeros + "1", "1" + zeros + "e-900"}) {
    EXPECT_EQ(cursor.number(small, "x"), 0) << small;
  }
  EXPECT_EQ(cursor.number("1" + zeros, "x"), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace mimetra
