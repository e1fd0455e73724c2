// Folders that hold more, less or other than the frames of one sequence.

#include <algorithm>
#include <array>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/io/file_numbers.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/sequence_file.h"
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

TEST_F(FolderOfFrames, PatternThatMatchesNothingIsTakenForTheOneThatFits) {
  write_frames({8, 9, 10});
  const auto found = [this](const std::string& name) {
    return frames_of_pattern((folder_ / name).string());
  };
  const FrameSeries unpadded = found("f_%04d.obj");
  EXPECT_THAT(unpadded.frames,
              ElementsAre(folder_ / "f_8.obj", folder_ / "f_9.obj", folder_ / "f_10.obj"));
  EXPECT_THAT(unpadded.notes,
              ElementsAre(AllOf(HasSubstr("f_%04d.obj: matches no file; '"),
                                HasSubstr("f_%d.obj' is taken for it, f_8.obj to f_10.obj"))));
  fs::remove(folder_ / "f_10.obj");
  fs::rename(folder_ / "f_8.obj", folder_ / "f_0008.obj");
  fs::rename(folder_ / "f_9.obj", folder_ / "f_0009.obj");
  EXPECT_EQ(found("f_%d.obj").frames.size(), 2U);
  EXPECT_THAT(found("f_%d.obj").notes, ElementsAre(HasSubstr("f_%04d.obj' is taken for it")));
  EXPECT_THAT(test::message_of<IoError>([&] { found("g_%d.obj"); }), testing::EndsWith("OM file"));
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

TEST_F(OrderOfFrames, IsThatOfDecimalNumbers) {
  // Without even steps, without a point in some, with as many digits behind the point.
  const std::vector<std::vector<std::string>> takes = {{"0.033", "0.1", "0.133", "2.5"},
                                                       {"0", "0.5"},
                                                       {"t_0", "t_0.04", "t_0.08", "t_0.12"},
                                                       {"t_0.10", "t_0.25", "t_0.50", "t_0.75"}};
  for (const std::vector<std::string>& stems : takes) {
    EXPECT_THAT(ordered(stems), ElementsAreArray(stems));
  }
  const std::vector<std::string> some = {"t_9", "t_9.5", "t_10", "t_10.5", "t_11", "t_11.5"};
  EXPECT_THAT(ordered(some), ElementsAreArray(some));
  EXPECT_THAT(series().notes, ElementsAre(HasSubstr("the numbers 9 to 11.5")));
  const std::vector<std::string> even = {"t_0.0", "t_0.25", "t_0.5", "t_0.75", "t_1.0", "t_1.25"};
  EXPECT_THAT(ordered(even), ElementsAreArray(even));
  EXPECT_THAT(series().notes,
              ElementsAre(AllOf(HasSubstr("0.0 to 1.25"), HasSubstr("not taken for times"))));
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

TEST_F(OrderOfFrames, BehindANumberAndAPointIsThatOfIntegers) {
  const std::vector<std::string> some = {"v1.8", "v1.9", "v1.11", "v1.12"};
  EXPECT_THAT(ordered(some), ElementsAreArray(some));
  // The last ones are even as decimals, too.
  const std::vector<std::vector<std::string>> takes = {
      {"v1.8", "v1.9", "v1.10", "v1.11"},
      {"v2.0009", "v2.0010", "v2.0011"},
      {"s1.2", "s1.3", "s1.4", "s1.5", "s1.6", "s1.7", "s1.8", "s1.9", "s1.10"}};
  for (const std::vector<std::string>& all : takes) {
    EXPECT_THAT(ordered(all), ElementsAreArray(all));
    EXPECT_THAT(series().notes, IsEmpty());
  }
}

TEST_F(OrderOfFrames, OfAPatternTakesAMeshBesideItsFrames) {
  for (const char* name : {"take1.obj", "take1.8.obj", "take1.9.obj", "take1.10.obj"}) write(name);
  EXPECT_EQ(frames_of_pattern((folder_ / "take1*.obj").string()).frames.size(), 4u);
}

TEST_F(OrderOfFrames, ThatNothingTellsIsRefused) {
  for (const char* name : {"t_0.1.obj", "t_0.25.obj", "t_0.5.obj", "t_0.75.obj"}) write(name);
  const auto names_both =
      AllOf(HasSubstr("/t_0.25.obj: comes before t_0.5.obj if their numbers are "
                      "decimal, and behind it if not"),
            HasSubstr("give all names as many digits behind the point"));
  EXPECT_THAT(refusal(), names_both);
  const std::string pattern = (folder_ / "t_*.obj").string();
  EXPECT_THAT(test::message_of<IoError>([&] { frames_of_pattern(pattern); }), names_both);
}

TEST_F(OrderOfFrames, OfNumbersThatAreEvenEitherWayOrNeitherIsRefused) {
  write_alone({"t_9.5", "t_10", "t_10.7", "t_11"});
  EXPECT_THAT(refusal(), HasSubstr("/t_10.obj: comes before t_10.7.obj if"));
  // 0.12, 0.21 and 0.3, or 3, 12 and 21.
  write_alone({"t_0.3", "t_0.12", "t_0.21"});
  EXPECT_THAT(refusal(), HasSubstr("/t_0.12.obj: comes before t_0.3.obj if"));
}

TEST_F(OrderOfFrames, IsAskedOfThoseThatAreTakenOnly) {
  write_frames({0, 1, 2, 3});
  write("f_1.5.obj");
  EXPECT_EQ(series().frames.size(), 4u);
  const std::string pattern = (folder_ / "f_*.obj").string();
  EXPECT_THAT(test::message_of<IoError>([&] { frames_of_pattern(pattern); }),
              HasSubstr("/f_1.obj: comes before f_1.5.obj if"));
}

/// Files of these numbers in another order, sorted.
std::vector<fs::path> sorted_again(std::vector<fs::path> files) {
  std::ranges::reverse(files);
  sort_by_numbers(files);
  return files;
}

TEST(SortedNumbers, AreInTheOrderOfTimesAsProgramsWriteThem) {
  for (const char* format : {"t_%g.obj", "t_%.17g.obj"}) {
    for (const double step : {0.5, 0.25, 0.1, 0.04, 0.01, 1.0 / 24, 1.0 / 30, 1.0 / 60}) {
      std::vector<fs::path> files;
      for (int i = 0; i < 130; ++i) {
        std::array<char, 64> name;
        std::snprintf(name.data(), name.size(), format, i * step);
        files.emplace_back(name.data());
      }
      EXPECT_EQ(sorted_again(files), files) << format << " in steps of " << step;
      EXPECT_FALSE(unclear_order(files)) << format << " in steps of " << step;
    }
  }
}

TEST(SortedNumbers, AreInTheOrderOfFramesBehindTheNumberOfATake) {
  for (int first = 0; first < 120; ++first) {
    for (int count = 2; count < 30; ++count) {
      std::vector<fs::path> files;
      files.reserve(static_cast<std::size_t>(count));
      for (int i = 0; i < count; ++i) {
        files.emplace_back("take1." + std::to_string(first + i) + ".obj");
      }
      EXPECT_EQ(sorted_again(files), files) << count << " from " << first;
      EXPECT_FALSE(unclear_order(files)) << count << " from " << first;
    }
  }
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

TEST(Patterns, OfOtherProgramsAreWrittenForPrintf) {
  EXPECT_EQ(printf_pattern("a/head.####.obj"), "a/head.%04d.obj");
  EXPECT_EQ(printf_pattern("head.@@@@.obj"), "head.%04d.obj");
  EXPECT_EQ(printf_pattern("head.$F4.obj"), "head.%04d.obj");
  EXPECT_EQ(printf_pattern("head_#.obj"), "head_%d.obj");
  EXPECT_EQ(printf_pattern("head_$F.obj"), "head_%d.obj");
  EXPECT_EQ(printf_pattern("head_{0..11}.obj"), "head_%d.obj");
  EXPECT_EQ(printf_pattern("head_{0001..0300}.obj"), "head_%04d.obj");
  EXPECT_EQ(printf_pattern("head_[0-9].obj"), "head_%d.obj");
  EXPECT_EQ(printf_pattern("head_[0-9][0-9].obj"), "head_%02d.obj");
  EXPECT_EQ(printf_pattern("head_{smile}.obj"), "");
  EXPECT_EQ(printf_pattern("head_{a..b}.obj"), "");
  EXPECT_EQ(printf_pattern("head_}..{.obj"), "");
  EXPECT_EQ(printf_pattern("head_{..}.obj"), "");
  EXPECT_EQ(printf_pattern("actor@identity003=1.5"), "");
  EXPECT_EQ(printf_pattern("head.obj"), "");
  for (const char* name : {"gone/h.####.obj", "gone/h.@@@@.obj", "gone/h.$F4.obj"}) {
    EXPECT_THAT(test::message_of<IoError>([&] { open_sequence(name); }),
                HasSubstr("is written 'gone/h.%04d.obj'"));
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
