#include <sys/stat.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "tests/test_folders.h"
#include "tests/vtk/vtp_fixture.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Damaged files, and files with sizes that cannot be true.
class VtpHostile : public VtpTest {
 protected:
  std::string refusal_of(const std::string& name, const std::string& text) const {
    std::ofstream(in_folder(name), std::ios::binary) << text;
    return message_of<IoError>([&] { read_vtp_series(in_folder(name)); });
  }
  /// Of a triangle, with one text in place of another.
  std::string refusal_with(const std::string& before, const std::string& after) const {
    std::string text = triangle_;
    text.replace(text.find(before), before.size(), after);
    return refusal_of("a.vtp", text);
  }

  const std::string triangle_ =
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt32\"><PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\">"
      "<PointData><DataArray type=\"Float32\" Name=\"roi\" format=\"ascii\">0 1 1</DataArray>"
      "</PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
      "format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points><Polys>"
      "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray></Polys></Piece>"
      "</PolyData></VTKFile>";
};

TEST_F(VtpHostile, NestingIsRefusedBeforeItFillsTheStack) {
  std::string deep;
  for (int level = 0; level < 200000; ++level) deep += "<a>";
  EXPECT_THAT(refusal_of("a.pvd", deep), HasSubstr("more than 32 elements"));
  EXPECT_THAT(refusal_of("a.vtp", deep), HasSubstr("more than 32 elements"));
}

TEST_F(VtpHostile, EntitiesAreRefused) {
  const std::string bomb =
      "<?xml version=\"1.0\"?><!DOCTYPE a [<!ENTITY b \"ha\"><!ENTITY c \"&b;&b;\">]>";
  EXPECT_THAT(refusal_of("a.pvd", bomb + "<VTKFile/>"), HasSubstr("<!ENTITY"));
  EXPECT_THAT(refusal_of("a.vtp", bomb + triangle_), HasSubstr("<!ENTITY"));
  EXPECT_THAT(refusal_of("b.pvd", "<VTKFile a=\"&c;\"/>"), HasSubstr("'&c'"));
}

TEST_F(VtpHostile, UnknownTypesAreNamed) {
  EXPECT_THAT(refusal_with("type=\"Float32\" Name=\"roi\"", "type=\"Float63\" Name=\"roi\""),
              AllOf(HasSubstr("array 'roi'"), HasSubstr("'Float63'")));
  EXPECT_THAT(refusal_with("type=\"PolyData\"", "type=\"ImageData\""), HasSubstr("ImageData"));
  EXPECT_THAT(refusal_with("UInt32", "UInt31"), HasSubstr("'UInt31'"));
  EXPECT_THAT(refusal_with("<PolyData>",
                           "<PolyData><FieldData><DataArray type=\"Float63\" "
                           "Name=\"RestPose\"/></FieldData>"),
              HasSubstr("FieldData, array 'RestPose'"));
  EXPECT_THAT(refusal_with("header_type", "compressor=\"vtkNone\" header_type"),
              HasSubstr("'vtkNone'"));
}

TEST_F(VtpHostile, CountsBeyondTheFileAreRefusedBeforeMemoryIsAskedFor) {
  EXPECT_THAT(refusal_with("NumberOfPoints=\"3\"", "NumberOfPoints=\"2000000000\""),
              HasSubstr("expected 2000000000 tuples, found 3"));
  EXPECT_THAT(refusal_with("NumberOfPoints=\"3\"", "NumberOfPoints=\"3000000000\""),
              HasSubstr("NumberOfPoints: 3000000000 is more than can be numbered"));
  EXPECT_THAT(refusal_with("NumberOfPolys=\"1\"", "NumberOfPolys=\"-1\""), HasSubstr("'-1'"));
  EXPECT_THAT(refusal_with("Name=\"roi\"", "NumberOfComponents=\"99999\" Name=\"roi\""),
              HasSubstr("NumberOfComponents"));
  EXPECT_THAT(refusal_with("NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""),
              HasSubstr("expected a multiple of 8"));
}

TEST_F(VtpHostile, CornersMayClaimToHaveComponents) {
  std::string text = triangle_;
  const std::string name = "Name=\"connectivity\"";
  text.insert(text.find(name), "NumberOfComponents=\"3\" ");
  std::ofstream(in_folder("a.vtp")) << text;
  EXPECT_EQ(read_vtp_series(in_folder("a.vtp")).sequence().triangles().rows(), 1);
}

TEST_F(VtpHostile, PointsWithoutAnArrayAreRefused) {
  const std::string points =
      "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
      "format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points>";
  EXPECT_THAT(refusal_with(points, "<Points/>"), HasSubstr("Points: expected an array"));
}

/// The file ends behind the first byte of a value.
TEST_F(VtpHostile, AShortArrayAtTheEndOfTheFileIsRefused) {
  std::string text = triangle_;
  const std::string ascii = "Name=\"roi\" format=\"ascii\">0 1 1";
  text.replace(text.find(ascii), ascii.size(), "Name=\"roi\" format=\"appended\" offset=\"0\">");
  text.insert(text.find("</VTKFile>"), "<AppendedData encoding=\"raw\">_");
  text.resize(text.find("</VTKFile>"));
  text.append("\1\0\0\0\1", 5);
  EXPECT_THAT(refusal_of("a.vtp", text), HasSubstr("array 'roi': holds 1 bytes"));
}

TEST_F(VtpHostile, BlocksThatAreLargerThanTheFileAreRefused) {
  // Before the values stands how many bytes they have: here 2^32 - 1.
  EXPECT_THAT(refusal_with("Name=\"roi\" format=\"ascii\">0 1 1",
                           "Name=\"roi\" format=\"binary\">/////w=="),
              HasSubstr("sizes of its blocks"));
  EXPECT_THAT(refusal_with("format=\"ascii\">0 1 1", "format=\"appended\" offset=\"9000000\">"),
              HasSubstr("offset"));
}

TEST_F(VtpHostile, BlocksThatUnpackToFarMoreThanTheFileAreRefused) {
  std::string text = triangle_;
  text.replace(text.find("header_type"), 11, "compressor=\"vtkZLibDataCompressor\" header_type");
  const std::string ascii = "Name=\"roi\" format=\"ascii\">0 1 1";
  // One block of 300 MB in 40002 bytes.
  text.replace(text.find(ascii), ascii.size(),
               "Name=\"roi\" format=\"binary\">AQAAAACj4REAAAAAQpwAAA==" + std::string(53336, 'A'));
  EXPECT_THAT(refusal_of("a.vtp", text), HasSubstr("would take more than 300 MB"));
}

TEST_F(VtpHostile, NoBlocksOfWhichTheLastHoldsSomethingAreRefused) {
  const std::string compressed = "compressor=\"vtkLZ4DataCompressor\" header_type";
  const auto refusal = [&](const std::string& sizes) {
    std::string text = triangle_;
    text.replace(text.find("header_type"), 11, compressed);
    const std::string ascii = "Name=\"roi\" format=\"ascii\">0 1 1";
    text.replace(text.find(ascii), ascii.size(), "Name=\"roi\" format=\"binary\">" + sizes);
    return refusal_of("a.vtp", text);
  };
  EXPECT_THAT(refusal("AAAAAACAAAAMAAAA"),
              AllOf(HasSubstr("array 'roi'"), HasSubstr("sizes of its blocks")));
  for (const char* cut : {"AAAA", "A=AAAACAAAAMAAAA"}) {
    EXPECT_THAT(refusal(cut), HasSubstr("truncated"));
  }
}

TEST_F(VtpHostile, OffsetsOfFacesThatDoNotFitAreRefused) {
  for (const std::string offset : {"4", "-3"}) {
    EXPECT_NE(
        refusal_with("\"offsets\" format=\"ascii\">3", "\"offsets\" format=\"ascii\">" + offset),
        "");
  }
}

TEST_F(VtpHostile, OffsetsThatEndBehindTheCornersAreRefusedHoweverTheyAreStored) {
  struct Stored {
    std::string header, format, sound, wrong;  ///< 3 and 2000000000
  };
  const std::vector<Stored> all = {
      {"header_type=\"UInt32\"", "ascii", "3", "2000000000"},
      {"header_type=\"UInt32\"", "ascii", "+3", "+2000000000"},
      {"header_type=\"UInt32\"", "binary", "BAAAAAMAAAA=", "BAAAAACUNXc="},
      {"header_type=\"UInt32\"", "binary", "BAAAAA==AwAAAA==", "BAAAAA==AJQ1dw=="},
      {"header_type=\"UInt64\"", "binary", "BAAAAAAAAAADAAAA", "BAAAAAAAAAAAlDV3"},
      {"header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\"", "binary",
       "AQAAAAQAAAAAAAAADAAAAA==eJxjZmBgAAAAEAAE", "AQAAAAQAAAAAAAAADAAAAA==eJxjmGJaDgACoQFB"},
      {"header_type=\"UInt32\" compressor=\"vtkLZ4DataCompressor\"", "binary",
       "AQAAAAQAAAAAAAAABQAAAA==QAMAAAA=", "AQAAAAQAAAAAAAAABQAAAA==QACUNXc="},
      {"header_type=\"UInt32\" compressor=\"vtkLZMADataCompressor\"", "binary",
       "AQAAAAQAAAAAAAAAPAAAAA==/"
       "Td6WFoAAATm1rRGAgAhARYAAAB0L+WjAQADAwAAAAAvfW541xiW0gABHARvLJzBH7bzfQEAAAAABFla",
       "AQAAAAQAAAAAAAAAPAAAAA==/"
       "Td6WFoAAATm1rRGAgAhARYAAAB0L+WjAQADAJQ1dwCK4flXxm+lFQABHARvLJzBH7bzfQEAAAAABFla"},
  };
  for (const Stored& each : all) {
    const auto with = [&](const std::string& offsets) {
      std::string text = triangle_;
      const std::string header = "header_type=\"UInt32\"";
      text.replace(text.find(header), header.size(), each.header);
      const std::string ascii = "\"offsets\" format=\"ascii\">3";
      return text.replace(text.find(ascii), ascii.size(),
                          "\"offsets\" format=\"" + each.format + "\">" + offsets);
    };
    std::ofstream(in_folder("sound.vtp")) << with(each.sound);
    EXPECT_EQ(read_vtp_series(in_folder("sound.vtp")).sequence().triangles().rows(), 1)
        << each.header << each.sound;
    EXPECT_THAT(refusal_of("a.vtp", with(each.wrong)),
                AllOf(HasSubstr("Polys, array 'offsets': ends at 2000000000"),
                      HasSubstr("there are 3 corners")))
        << each.header << each.wrong;
  }
}

TEST_F(VtpHostile, GapsInBase64AreRefused) {
  // 12 bytes: 0, 1 and 1 in single precision.
  const std::string sound = "DAAAAAAAAAAAAIA/AACAPw==";
  const auto with = [&](const std::string& values) {
    std::string text = triangle_;
    const std::string ascii = "Name=\"roi\" format=\"ascii\">0 1 1";
    return text.replace(text.find(ascii), ascii.size(), "Name=\"roi\" format=\"binary\">" + values);
  };
  std::ofstream(in_folder("sound.vtp")) << with("\n  " + sound + "\n");
  EXPECT_EQ(read_vtp_field(in_folder("sound.vtp"), "roi"), Eigen::Vector3d(0, 1, 1));
  for (const char* gap : {"\n", " ", "!!!!", "===="}) {
    std::string text = sound;
    EXPECT_THAT(refusal_of("a.vtp", with(text.insert(8, gap))),
                AllOf(HasSubstr("array 'roi'"), HasSubstr("gaps")));
  }
  EXPECT_THAT(refusal_of("a.vtp", with(sound.substr(0, 16))), HasSubstr("truncated"));
}

TEST_F(VtpHostile, TimesThatFallOrRepeatAreNamed) {
  const auto list = [](const std::string& first, const std::string& second) {
    return "<VTKFile><Collection><DataSet timestep=\"" + first +
           "\" file=\"a.vtp\"/><DataSet timestep=\"" + second +
           "\" file=\"b.vtp\"/></Collection></VTKFile>";
  };
  EXPECT_THAT(refusal_of("a.pvd", list("2", "1")),
              AllOf(HasSubstr("b.vtp is at the time 1"), HasSubstr("later one than 2 of a.vtp")));
  EXPECT_THAT(refusal_of("a.pvd", list("1", "1")), HasSubstr("times must ascend"));
  EXPECT_THAT(refusal_of("a.pvd", list("nan", "1")), HasSubstr("a.vtp is at the time nan"));
}

TEST_F(VtpHostile, AListThatNamesItselfOrADeviceEnds) {
  const auto list = [](const std::string& file) {
    return "<VTKFile><Collection><DataSet timestep=\"0\" file=\"" + file +
           "\"/></Collection></VTKFile>";
  };
  EXPECT_THAT(refusal_of("a.pvd", list("a.pvd")), HasSubstr("PolyData"));
  EXPECT_THAT(refusal_of("b.pvd", list("/dev/zero")), HasSubstr("/dev/zero: is a device"));
  ASSERT_EQ(mkfifo(in_folder("pipe.vtp").c_str(), 0600), 0);
  EXPECT_THAT(refusal_of("c.pvd", list("pipe.vtp")), HasSubstr("is a named pipe"));
}

TEST_F(VtpHostile, WhatSinglePrecisionCannotHoldIsNotWritten) {
  FieldSequence fields = quad_and_triangle();
  Frames frames = fields.sequence().positions();
  frames(1, 4) = 1e39;
  fields.frames = std::make_shared<const MeshSequence>(fields.sequence().with_frames(frames));
  EXPECT_THAT(message_of<MismatchError>([&] { write_vtp_series(fields, in_folder("a.pvd")); }),
              HasSubstr("single precision"));
  EXPECT_TRUE(folder_is_empty());
}

}  // namespace
}  // namespace mimetra::test
