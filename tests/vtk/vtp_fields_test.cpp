// Fields of a series, which are those of the mesh in all its frames.

#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>

#include "tests/temporary_folder.h"
#include "tests/vtk/vtp_fixture.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class VtpFields : public VtpTest {
 protected:
  /// A series in which each frame has the fields, and the faces, that `frame(index)` gives.
  void write(int frames, const std::function<FieldSequence(int frame)>& frame) const {
    std::string files;
    for (int f = 0; f < frames; ++f) {
      const std::string number = std::to_string(f);
      write_vtp_series(frame(f), in_folder(number + ".vtp"), {.overwrite = true});
      files += (files.empty() ? "" : ", ") + ("{\"name\": \"" + number) +
               ".vtp\", \"time\": " + number + "}";
    }
    std::ofstream(in_folder("a.vtp.series"))
        << "{\"file-series-version\": \"1.0\", \"files\": [" << files << "]}";
  }

  /// The quad and the triangle, which stay where they are, with one more field.
  static FieldSequence with(Field field) {
    FieldSequence mesh = quad_and_triangle();
    mesh.displacement = false;
    mesh.fields.push_back(std::move(field));
    return mesh;
  }
  static FieldSequence with_heat(double heat) {
    return with({"heat", Field::Location::vertices, Eigen::VectorXd::Constant(5, heat)});
  }

  struct Read {
    std::vector<std::string> names, notes;
    FieldSequence series;
  };
  Read read(const ReadOptions& options = {.fields = true}) const {
    Read found;
    const auto take_note = [&found](const Note& note) { found.notes.push_back(note.text); };
    found.series =
        open_vtp_series(in_folder("a.vtp.series"), options, Context().with_notes(take_note));
    for (const Field& field : found.series.fields) found.names.push_back(field.name);
    return found;
  }
};

TEST_F(VtpFields, ThatChangeOverTheFramesAreLeftOutAndNamed) {
  write(4, [](int frame) { return with_heat(10 * frame); });
  const Read found = read();
  EXPECT_THAT(found.names, ElementsAre("region", "direction", "in_L"));
  EXPECT_THAT(
      found.notes,
      ElementsAre(AllOf(
          HasSubstr("a field that changes over the frames, or is not in all, is left out: heat;"),
          HasSubstr("(option 'frames' k:k+1)"), Not(HasSubstr("region")))));
}

TEST_F(VtpFields, ThatChangeOnTrianglesAreLeftOut) {
  write(3, [](int frame) {
    return with({"seen", Field::Location::triangles, Eigen::Vector3d(0, 0, frame == 2)});
  });
  EXPECT_THAT(read().names, ElementsAre("region", "direction", "in_L"));
}

TEST_F(VtpFields, ThatALaterFrameDoesNotHaveSoAreLeftOut) {
  for (const Eigen::MatrixXd& other :
       {Eigen::MatrixXd::Ones(5, 2).eval(), Eigen::MatrixXd::Zero(5, 1).eval()}) {
    write(2, [&other](int frame) {
      return frame == 0 ? with_heat(1) : with({"heat", Field::Location::vertices, other});
    });
    EXPECT_THAT(read().names, ElementsAre("region", "direction", "in_L"));
  }
  write(2, [](int frame) { return frame == 0 ? with_heat(1) : quad_and_triangle(); });
  EXPECT_THAT(read().notes, ElementsAre(HasSubstr("heat")));
}

TEST_F(VtpFields, OfAChosenFrameAreItsOwn) {
  write(4, [](int frame) { return with_heat(10 * frame); });
  const Read found = read({.frames = "2:3", .fields = true});
  EXPECT_THAT(found.notes, IsEmpty());
  EXPECT_TRUE(found.series.fields.at(2).values == Eigen::VectorXd::Constant(5, 20));
}

TEST_F(VtpFields, AreComparedInAllFrames) {
  constexpr int kFrames = 40;
  write(kFrames, [](int) { return with_heat(0); });
  for (const int changed : {1, 7, 22, kFrames - 1}) {
    const auto file = in_folder(std::to_string(changed) + ".vtp");
    write_vtp_series(with_heat(1), file, {.overwrite = true});
    EXPECT_THAT(read().notes, ElementsAre(HasSubstr("heat"))) << changed;
    write_vtp_series(with_heat(0), file, {.overwrite = true});
  }
}

TEST_F(VtpFields, ThatTheFirstFrameDoesNotHaveAreNamed) {
  write(3, [](int frame) { return frame == 0 ? quad_and_triangle() : with_heat(1); });
  EXPECT_THAT(read().notes,
              ElementsAre(AllOf(HasSubstr("or is not in all, is left out: "), HasSubstr("heat"))));
}

TEST_F(VtpFields, ThatAreNotWantedAreNotLookedFor) {
  write(2, [](int frame) { return with_heat(frame); });
  std::ofstream(in_folder("1.vtp")) << "<VTKFile";
  const Read found = read({.fields = false});
  EXPECT_THAT(found.names, IsEmpty());
  EXPECT_THAT(found.notes, IsEmpty());
}

TEST_F(VtpFields, ThatAreNoNumbersInTheSamePlacesStay) {
  write(2, [](int) { return with_heat(std::numeric_limits<double>::quiet_NaN()); });
  const Read found = read();
  EXPECT_THAT(found.names, ElementsAre("region", "direction", "heat", "in_L"));
  EXPECT_THAT(found.notes, IsEmpty());
}

TEST_F(VtpFields, CalledDisplacementThatChangeAndLeadFromNoPoseAreLeftOut) {
  write(4, [](int frame) {
    const Eigen::MatrixXd step = Eigen::MatrixXd::Constant(5, 3, frame);
    return with({kDisplacement, Field::Location::vertices, step * frame});
  });
  const Read found = read();
  EXPECT_FALSE(found.series.frames->rest_is_known());
  EXPECT_THAT(found.names, ElementsAre("region", "direction", "in_L"));
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("is left out: displacement;")));
}

TEST_F(VtpFields, OfASeriesThatMimetraWritesAreAllReadWithoutANote) {
  write_vtp_series(quad_and_triangle(), in_folder("a.pvd"));
  const Read found = read();
  EXPECT_TRUE(found.series.frames->rest_is_known());
  EXPECT_THAT(found.names, ElementsAre("region", "direction", "in_L"));
  EXPECT_THAT(found.notes, IsEmpty());
}

/// The same mesh with the triangle before the quad, and a field of its own on each.
FieldSequence in_another_order(const FieldSequence& mesh, bool is_flipped) {
  const Polygons polygons = is_flipped ? Polygons{{1, 4, 2, 3, 2, 1, 0}, {0, 3, 7}}
                                       : Polygons{{4, 2, 1, 2, 3, 0, 1}, {0, 3, 7}};
  FieldSequence other(MeshSequence(Connectivity::from_polygons(5, polygons),
                                   mesh.sequence().positions().bottomRows(1)),
                      mesh.fields);
  other.fields.back().values = Eigen::Vector3d(0, 1, 1);
  return other;
}

TEST_F(VtpFields, AndVerticesOfAFrameWithItsFacesInAnotherOrderAreTheSame) {
  FieldSequence mesh = quad_and_triangle();
  mesh.displacement = false;
  write(2, [&mesh](int frame) { return frame == 0 ? mesh : in_another_order(mesh, false); });
  const Read found = read();
  EXPECT_THAT(found.names, ElementsAre("region", "direction", "in_L"));
  EXPECT_THAT(found.notes, IsEmpty());
  // Single precision.
  EXPECT_TRUE(found.series.frames->read(1, 1).isApprox(mesh.sequence().positions().row(2), 1e-6));
  EXPECT_TRUE(same_faces(found.series.frames->connectivity(), mesh.sequence().connectivity()));
}

TEST_F(VtpFields, OfFramesWithAFlippedFaceAreRefused) {
  FieldSequence mesh = quad_and_triangle();
  mesh.displacement = false;
  write(2, [&mesh](int frame) { return frame == 0 ? mesh : in_another_order(mesh, true); });
  EXPECT_THAT(message_of<MismatchError>([this] { read(); }),
              HasSubstr("1.vtp: other vertices or faces than "));
}

/// A field of whole numbers, of which the first is `number`.
FieldSequence with_number(double number) {
  FieldSequence mesh = quad_and_triangle();
  Field ids{"ids", Field::Location::vertices, Eigen::VectorXd::LinSpaced(5, 0, 4), true};
  ids.values(0) = number;
  mesh.fields = {ids};
  return mesh;
}

TEST_F(VtpFields, OfWholeNumbersAreWrittenWithAsManyBitsAsTheyNeed) {
  const auto type_of = [this](double number) {
    write_vtp_series(with_number(number), in_folder("a.vtp"), {.overwrite = true});
    const std::string text = bytes_of(in_folder("a.vtp"));
    const std::size_t name = text.find("\" Name=\"ids\"");
    const std::size_t type = text.rfind('"', name - 1) + 1;
    return text.substr(type, name - type);
  };
  const double of_32 = std::ldexp(1, 31), of_64 = std::ldexp(1, 63);
  EXPECT_EQ(type_of(of_32 - 1), "Int32");
  EXPECT_EQ(type_of(-of_32), "Int32");
  EXPECT_EQ(type_of(of_32), "Int64");
  EXPECT_EQ(type_of(-of_32 - 1), "Int64");
  EXPECT_EQ(type_of(-of_64), "Int64");
  // Exact: they come as double precision has them.
  EXPECT_EQ(type_of(of_64), "Float64");
  EXPECT_EQ(type_of(std::numeric_limits<double>::quiet_NaN()), "Float64");
}

TEST_F(VtpFields, OfWholeNumbersComeBackToTheLastDigit) {
  for (const double number : {5e9, -5e9, std::ldexp(1, 53) - 1, -std::ldexp(1, 63)}) {
    const FieldSequence written = with_number(number);
    write_vtp_series(written, in_folder("a.vtp"), {.overwrite = true});
    const Field read = read_vtp_series(in_folder("a.vtp")).fields.at(0);
    EXPECT_TRUE(read.values == written.fields[0].values) << number;
    EXPECT_TRUE(read.integer) << number;
  }
  const FieldSequence written = with_number(std::ldexp(1, 64));
  write_vtp_series(written, in_folder("a.vtp"), {.overwrite = true});
  EXPECT_TRUE(read_vtp_series(in_folder("a.vtp")).fields.at(0).values == written.fields[0].values);
}

TEST_F(VtpFields, WhoseWholeNumbersDoublePrecisionRoundsAreNamed) {
  write(1, [](int) { return with_number(std::ldexp(1, 53) - 1); });
  EXPECT_THAT(read().notes, IsEmpty());
  write(1, [](int) { return with_number(std::ldexp(1, 53)); });
  EXPECT_THAT(read().notes,
              ElementsAre(AllOf(HasSubstr("from 2^53 on are rounded"), HasSubstr("field ids; "))));
}

}  // namespace
}  // namespace mimetra::test
