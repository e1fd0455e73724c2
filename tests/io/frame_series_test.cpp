// Folders that hold more, less or other than the frames of one sequence.

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;

class FolderOfFrames : public testing::Test {
 protected:
  /// A triangle whose last corner is at height `y`.
  void write(const std::string& name, double y = 1) {
    write_bytes(folder_ / name, "v 0 0 0\nv 1 0 0\nv 0 " + std::to_string(y) + " 0\nf 1 2 3\n");
  }
  void write_frames(std::initializer_list<int> numbers) {
    for (const int number : numbers) write("f_" + std::to_string(number) + ".obj", number + 1);
  }
  FrameSeries series() const { return frames_of_folder(folder_.path()); }
  std::string refusal() const {
    return test::message_of<IoError>([this] { frames_of_folder(folder_.path()); });
  }

  test::TemporaryFolder folder_;
};

TEST_F(FolderOfFrames, TakesANeutralForTheRestPose) {
  write_frames({0, 1, 2});
  write("Neutral.obj", 7);
  EXPECT_FALSE(is_model(folder_.path()));
  const OpenSequence open = open_sequence(folder_.path());
  EXPECT_EQ(open.frames->frames(), 3);
  EXPECT_TRUE(open.frames->rest_is_known());
  EXPECT_EQ(open.frames->rest()(2, 1), 7);
  EXPECT_THAT(open.notes, ElementsAre(AllOf(HasSubstr("Neutral.obj"), HasSubstr("rest pose"))));
}

TEST_F(FolderOfFrames, HasNumbersInItsNames) {
  for (const char* name : {"neutral.obj", "blink.obj", "frown.obj", "smile.obj"}) write(name);
  write("identity0.obj");
  write("identity1.obj");
  EXPECT_THAT(test::message_of<MismatchError>([this] { frames_of_folder(folder_.path()); }),
              AllOf(HasSubstr("5 meshes without frame numbers"), HasSubstr("/*.obj'")));
  EXPECT_EQ(open_sequence(folder_ / "*.obj").frames->frames(), 6);
  write("identity2.obj");
  write("identity3.obj");
  EXPECT_EQ(series().frames.size(), 4U);
}

TEST_F(FolderOfFrames, IsAModelWithExpressionsWhateverElseItHolds) {
  write_frames({0, 1, 2});
  write("neutral.obj", 7);
  fs::create_directory(folder_ / "expressions");
  write("expressions/smile.obj", 8);
  EXPECT_TRUE(is_model(folder_.path()));
  const OpenSequence open = open_sequence(folder_.path());
  EXPECT_EQ(open.frames->frames(), 1);
  EXPECT_THAT(open.notes, ElementsAre(AllOf(HasSubstr("read as a model"), HasSubstr("3 other"),
                                            HasSubstr("f_0.obj"))));
}

TEST_F(FolderOfFrames, LeavesStrangersOutAndNamesThem) {
  write_frames({0, 1, 2});
  write("smile.obj");
  EXPECT_EQ(series().frames.size(), 3u);
  EXPECT_THAT(series().notes,
              ElementsAre(HasSubstr("smile.obj is left out of the 3 frames f_*.obj")));
  // A pattern says that it is meant.
  const FrameSeries asked = frames_of_pattern((folder_ / "*.obj").string());
  EXPECT_EQ(asked.frames.size(), 4u);
  EXPECT_THAT(asked.notes, ElementsAre(HasSubstr("smile.obj is a frame too")));
}

TEST_F(FolderOfFrames, RefusesTwoTakesAndNamesAPatternForEach) {
  write_frames({1, 2, 3});
  for (const char* name : {"g_1.obj", "g_2.obj", "g_3.obj"}) write(name);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("holds several takes, 3 files f_*.obj, 3 files g_*.obj"),
                               HasSubstr("/f_*.obj'"), HasSubstr("/g_*.obj'")));
  EXPECT_EQ(frames_of_pattern((folder_ / "g_*.obj").string()).frames.size(), 3u);
  EXPECT_EQ(frames_of_pattern((folder_ / "*.obj").string()).frames.size(), 6u);
}

TEST_F(FolderOfFrames, NamesMissingNumbers) {
  write_frames({0, 1, 3, 4, 8});
  EXPECT_THAT(series().notes, ElementsAre(HasSubstr("no file has these numbers: 2, 5 to 7")));
  EXPECT_EQ(series().frames.size(), 5u);
}

TEST_F(FolderOfFrames, MayCountInSteps) {
  write_frames({10, 20, 30, 40});
  EXPECT_THAT(series().notes, IsEmpty());
}

TEST_F(FolderOfFrames, RefusesTwoFilesOfOneNumber) {
  write_frames({0, 1, 2});
  write("f_01.obj");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("f_01.obj"), HasSubstr("f_1.obj"), HasSubstr("number")));
}

TEST_F(FolderOfFrames, RefusesALinkThatLeadsNowhere) {
  write_frames({0, 1});
  fs::create_symlink("gone.obj", folder_ / "f_2.obj");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("f_2.obj"), HasSubstr("leads nowhere, to gone.obj")));
  const std::string pattern = (folder_ / "f_%d.obj").string();
  EXPECT_THAT(test::message_of<IoError>([&] { frames_of_pattern(pattern); }),
              HasSubstr("leads nowhere"));
}

TEST_F(FolderOfFrames, OfAModelRefusesALinkThatLeadsNowhereToo) {
  write("neutral.obj");
  fs::create_directory(folder_ / "expressions");
  write("expressions/smile.obj", 8);
  fs::create_symlink("gone.obj", folder_ / "expressions/jawOpen.obj");
  EXPECT_THAT(test::message_of<IoError>([this] { read_model(folder_.path()); }),
              AllOf(HasSubstr("jawOpen.obj"), HasSubstr("leads nowhere")));
}

TEST_F(FolderOfFrames, PatternThatMatchesNothingNamesTheOneThatFits) {
  write_frames({8, 9, 10});
  const auto refusal = [this](const std::string& name) {
    return test::message_of<IoError>([&] { frames_of_pattern((folder_ / name).string()); });
  };
  EXPECT_THAT(refusal("f_%04d.obj"), AllOf(HasSubstr("f_%04d.obj: matches no file; '"),
                                           HasSubstr("f_%d.obj' matches f_8.obj to f_10.obj")));
  fs::remove(folder_ / "f_10.obj");
  fs::rename(folder_ / "f_8.obj", folder_ / "f_0008.obj");
  fs::rename(folder_ / "f_9.obj", folder_ / "f_0009.obj");
  EXPECT_THAT(refusal("f_%d.obj"), HasSubstr("f_%04d.obj' matches f_0008.obj to f_0009.obj"));
  EXPECT_THAT(refusal("g_%d.obj"), testing::EndsWith("OM file"));
}

TEST_F(FolderOfFrames, PatternThatMatchesSomeFilesNamesTheOthersAndThePatternOfAll) {
  write_frames({8, 9, 10, 11});
  const FrameSeries some = frames_of_pattern((folder_ / "f_%02d.obj").string());
  EXPECT_EQ(some.frames.size(), 2u);
  EXPECT_THAT(some.notes,
              ElementsAre(AllOf(HasSubstr("f_8.obj, f_9.obj are left out of the 4 files"),
                                HasSubstr("write '" + (folder_ / "f_%d.obj").string() + "'"))));
  EXPECT_THAT(frames_of_pattern((folder_ / "f_%d.obj").string()).notes, IsEmpty());
  write("f_012.obj");  // padded: none of printf writes all five
  EXPECT_THAT(frames_of_pattern((folder_ / "f_%d.obj").string()).notes,
              ElementsAre(AllOf(HasSubstr("f_012.obj is left out of the 5 files"),
                                HasSubstr("write '" + (folder_ / "f_*.obj").string() + "'"))));
}

class OrderOfFrames : public FolderOfFrames {
 protected:
  /// Writes the files, and no others.
  void write_alone(const std::vector<std::string>& stems) {
    for (const std::string& name : folder_.names()) fs::remove(folder_ / name);
    for (const std::string& stem : stems) write(stem + ".obj");
  }

  /// Writes the files, and no others, and returns their names in the order of frames.
  std::vector<std::string> ordered(const std::vector<std::string>& stems) {
    write_alone(stems);
    std::vector<std::string> names;
    for (const fs::path& frame : series().frames) names.push_back(frame.stem().string());
    return names;
  }
};

TEST_F(OrderOfFrames, BeginsWithNumbersBelowZero) {
  EXPECT_THAT(ordered({"f_-1", "f_-2", "f_-10", "f_0", "f_1", "f_2"}),
              ElementsAre("f_-10", "f_-2", "f_-1", "f_0", "f_1", "f_2"));
  EXPECT_THAT(series().notes, ElementsAre(HasSubstr("no file has these numbers: -9 to -3")));
}

TEST_F(OrderOfFrames, TakesAMinusForASignBehindASeparatorOnly) {
  EXPECT_THAT(ordered({"head.-1", "head.-2", "head.0"}),
              ElementsAre("head.-2", "head.-1", "head.0"));
  EXPECT_EQ(frames_of_pattern((folder_ / "head.%d.obj").string()).frames.size(), 3u);
  EXPECT_THAT(ordered({"head-001", "head-002", "head-003"}),
              ElementsAre("head-001", "head-002", "head-003"));
}

TEST_F(OrderOfFrames, IsNamedWhereAllNumbersAreBelowZero) {
  EXPECT_THAT(ordered({"f_-001", "f_-002"}), ElementsAre("f_-002", "f_-001"));
  EXPECT_THAT(series().notes, ElementsAre(HasSubstr("all frames have numbers below 0")));
}

TEST_F(OrderOfFrames, OfPaddedNumbersBelowZeroMatchesThePatternOfAnyProgram) {
  // printf writes -0001 and 00000, Blender -00001 and 00000.
  for (const char* name : {"a_-0001.obj", "a_00000.obj", "b_-00001.obj", "b_00000.obj"}) {
    write(name);
  }
  for (const char* pattern : {"a_%05d.obj", "b_%05d.obj"}) {
    const FrameSeries found = frames_of_pattern((folder_ / pattern).string());
    EXPECT_EQ(found.frames.size(), 2u);
    EXPECT_THAT(found.notes, IsEmpty());
  }
}

TEST_F(OrderOfFrames, LeavesOutAMeshThatIsNamedAsItsTake) {
  // Beside frames of any step, also where its number is 0.
  const std::vector<std::vector<std::string>> takes = {
      {"shot0", "shot0.0101", "shot0.0102", "shot0.0103"},
      {"mesh_1", "mesh_1.0002", "mesh_1.0004", "mesh_1.0006"},
      {"take1", "take1.1", "take1.2", "take1.3"}};
  for (const std::vector<std::string>& stems : takes) {
    EXPECT_THAT(ordered(stems), ElementsAreArray(stems.begin() + 1, stems.end()));
  }
  EXPECT_THAT(series().notes, ElementsAre(HasSubstr("take1.obj is left out of the 3 frames")));
}

/// In the same order, whole or decimal, they are taken; else only a pattern tells.
TEST_F(OrderOfFrames, BehindANumberAndAPointMustNotDependOnWhatThePointIs) {
  const std::vector<std::vector<std::string>> takes = {
      {"v1.8", "v1.9"}, {"v2.0009", "v2.0010", "v2.0011"}, {"t_0.10", "t_0.25", "t_0.50"}};
  for (const std::vector<std::string>& all : takes) {
    EXPECT_THAT(ordered(all), ElementsAreArray(all));
  }
  for (const std::vector<std::string>& all : std::vector<std::vector<std::string>>{
           {"v1.8", "v1.9", "v1.10"}, {"v1.1", "v1.5", "v1.25"}}) {
    write_alone(all);
    const std::string pattern = (folder_ / "v1.%d.obj").string();
    const auto names_both = AllOf(HasSubstr("/" + all[2] + ".obj: comes before " + all[1] +
                                            ".obj if their numbers are decimal, and behind it if"),
                                  HasSubstr("by a pattern, '" + pattern + "'"));
    EXPECT_THAT(refusal(), names_both);
    const std::string glob = (folder_ / "v*.obj").string();
    EXPECT_THAT(test::message_of<IoError>([&] { frames_of_pattern(glob); }), names_both);
    std::vector<std::string> names;
    for (const fs::path& frame : frames_of_pattern(pattern).frames) {
      names.push_back(frame.stem().string());
    }
    EXPECT_THAT(names, ElementsAreArray(all));
  }
}

TEST_F(OrderOfFrames, OfTimesWithoutAPointInSomeIsRefused) {
  write_alone({"t_9.5", "t_10", "t_10.5", "t_11"});
  const std::string glob = (folder_ / "t_*.obj").string();
  EXPECT_THAT(test::message_of<IoError>([&] { frames_of_pattern(glob); }),
              HasSubstr("comes before"));
  // A number that is too large to count.
  write_alone({"t_0.5", "t_0.10000000000000000555"});
  EXPECT_THAT(test::message_of<IoError>([&] { frames_of_pattern(glob); }),
              testing::EndsWith("as many digits behind the point"));
}

TEST_F(OrderOfFrames, OfTimesThatPassAWholeSecondIsRefused) {
  const std::vector<std::string> all = {"t_0.92", "t_0.96", "t_1.00"};
  write_alone(all);
  const std::string folder = folder_.path().string() + "/";
  EXPECT_THAT(refusal(), AllOf(HasSubstr("t_1.00.obj: may continue t_0.*.obj"),
                               HasSubstr("'" + folder + "t_*.*.obj'"),
                               HasSubstr("'" + folder + "t_0.*.obj'")));
  std::vector<std::string> names;
  for (const fs::path& frame : frames_of_pattern(folder + "t_*.*.obj").frames) {
    names.push_back(frame.stem().string());
  }
  EXPECT_THAT(names, ElementsAreArray(all));
}

TEST_F(OrderOfFrames, IsAskedOfThoseThatAreTakenOnly) {
  write_frames({0, 1, 2, 3});
  write("f_1.5.obj");
  EXPECT_EQ(series().frames.size(), 4u);
}

TEST_F(FolderOfFrames, OfOneNumberAreNamedByTheirFoldersOrPatterns) {
  for (const char* take : {"a", "b"}) {
    fs::create_directory(folder_ / take);
    write(std::string(take) + "/f_1.obj");
  }
  const std::string all = (folder_ / "*").string() + "/*.obj";
  EXPECT_THAT(test::message_of<IoError>([&] { frames_of_pattern(all); }),
              AllOf(HasSubstr("several takes; "), testing::Not(HasSubstr("remove")),
                    testing::EndsWith("name one folder, " + (folder_ / "a").string() + " or " +
                                      (folder_ / "b").string())));
  write("a/f_01.obj");
  EXPECT_THAT(test::message_of<IoError>([&] { frames_of_folder(folder_ / "a"); }),
              AllOf(HasSubstr("/f_%d.obj'"), HasSubstr("/f_%02d.obj'")));
}

TEST(Patterns, OfOtherProgramsAreNamed) {
  for (const char* name : {"gone/h.####.obj", "gone/h.@@@@.obj", "gone/h.$F4.obj",
                           "gone/h_{0001..0300}.obj", "gone/h_[0-9].obj"}) {
    EXPECT_THAT(test::message_of<IoError>([&] { open_sequence(name); }),
                HasSubstr("by a pattern such as 'gone/frame_%04d.obj'"));
  }
}

TEST_F(FolderOfFrames, PatternOfPrintfWithAStarNamesTheStar) {
  write_frames({1, 2});
  EXPECT_THAT(
      test::message_of<IoError>([this] { frames_of_pattern((folder_ / "*_%d.obj").string()); }),
      HasSubstr("write '*' in the place of the number, too"));
}

}  // namespace
}  // namespace mimetra
