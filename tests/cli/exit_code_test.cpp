#include <gmock/gmock.h>

#include "tests/cli/run_here.h"

namespace mimetra {
namespace {

using testing::HasSubstr;

class ExitCode : public test::QuickCommandTest {
 protected:
  /// The run fails as documented, says so, prints no result, and leaves the folder as it was.
  void expect_failure(const std::string& arguments, int code, const std::string& message) {
    const auto before = listing();
    const auto result = run(arguments);
    EXPECT_EQ(result.code, code) << arguments << '\n' << result.err;
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_EQ(listing(), before) << arguments;
  }
};

TEST_F(ExitCode, OfTheProgramIsThatOfTheKindOfError) {
  const auto before = listing();
  for (const auto& [arguments, code] :
       {std::pair("info head --weights take.csv --frames 5:2", 2), std::pair("info missing.obj", 3),
        std::pair("info head --weights take.csv --frames 1:99", 4),
        std::pair("convert head -o take.csv/x.npy", 5)}) {
    const auto result = CommandTest::run(arguments);
    EXPECT_EQ(result.code, code) << arguments << '\n' << result.err;
    EXPECT_THAT(result.err, HasSubstr("mimetra: error: ")) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
  }
  EXPECT_EQ(listing(), before);
}

TEST_F(ExitCode, Is2WhereSeveralProcessesWouldEachDoAllOfTheWork) {
  std::filesystem::copy("/bin/sh", folder_ / "mpirun");
  const std::string starts_it = R"( -c '"$0" "$@"; exit $?')";
  const std::string work = "convert head --weights take.csv -o x.npy --force";
  for (const std::string variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const auto before = listing();
    const auto several = run(work, variable + "=3 ./mpirun" + starts_it);
    EXPECT_EQ(several.code, 2);
    EXPECT_THAT(several.err, HasSubstr("mpirun started 3 processes"));
    EXPECT_THAT(several.err, HasSubstr("'./dev build mpi'"));
    EXPECT_EQ(listing(), before);
    EXPECT_EQ(run(work, variable + "=1 ./mpirun" + starts_it).code, 0);
    // Scripts that run on processes of MPI start it for work of their own.
    EXPECT_EQ(run(work, variable + "=3 sh" + starts_it).code, 0);
    EXPECT_EQ(CommandTest::run(work).code, 0);
  }
}

TEST_F(ExitCode, Is5ForAStandardOutputThatIsClosedWhateverFilesAreOpened) {
  // More than is kept in memory of files that are read once: the rest is in a file without a name.
  std::string weights = "time,left\n";
  for (int frame = 0; frame < 3200; ++frame) {
    weights += std::to_string(frame / 60.0) + ',' + std::to_string(frame % 100 / 100.0) + '\n';
  }
  write("long.csv", weights);
  ASSERT_EQ(run("convert head --weights long.csv -o frames/").code, 0);
  EXPECT_EQ(run("align frames -o a.npy >&-").code, 5);
  EXPECT_EQ(run("align frames -o b.npy --on all 2>&-").code, 0);
  EXPECT_EQ(CommandTest::run("align frames -o c.npy --on all").code, 0);
  EXPECT_EQ(text_of(folder_ / "b.npy"), text_of(folder_ / "c.npy"));
}

TEST_F(ExitCode, Is2ForAPatternWithoutQuotesWhichIsNamed) {
  run("convert head --weights take.csv --frames 0:5 -o f/ --format obj");
  const auto before = listing();
  for (const std::string line :
       {"info f/*.obj", "convert f/*.obj -o g/", "transfer f/*.obj head -o x"}) {
    const auto result = run(line);
    EXPECT_EQ(result.code, 2) << line << '\n' << result.err;
    EXPECT_THAT(result.err,
                testing::AllOf(HasSubstr("got 5 files, f/frame_0000.obj to f/frame_0004.obj"),
                               HasSubstr("write 'f/*.obj' in quotes")))
        << line;
    EXPECT_EQ(result.out, "") << line;
    EXPECT_EQ(listing(), before) << line;
  }
}

TEST_F(ExitCode, Is2ForAValueThatIsWrongWhateverTheData) {
  expect_failure("decompose head --weights take.csv -k 0 -o c.h5", 2, "-k: expected");
  expect_failure("decompose head --weights take.csv --d-min 0.8 -o c.h5", 2, "--d-min");
  expect_failure("decompose head --weights take.csv -o c.txt", 2, ".h5");
  for (const std::string memory : {"much", "-1G", "0", "4X", "nan", "4", "4Ki", "B"}) {
    expect_failure("decompose head --weights take.csv -o c.h5 --memory " + memory, 2,
                   "--memory: expected a number with the unit k, M, G or T, such as 4G, found '" +
                       memory + "'");
  }
  for (const std::string memory : {"4g", "4GB", "4GiB", "4096m", "4000000000"}) {
    EXPECT_EQ(run("decompose head --weights take.csv -o c.h5 --dry-run --memory " + memory).code, 0)
        << memory;
  }
  expect_failure("transfer head --weights take.csv head -o x --region ball", 2, "disc, support");
  expect_failure("info head --weights take.csv --frames 5:2", 2, "5:2");
}

TEST_F(ExitCode, Is2ForAnOutputThatTheRequestCannotMake) {
  const std::string source = "transfer head --weights take.csv ";
  expect_failure(source + "head --space vertex -o x --weights-out w.csv", 2, "--weights-out");
  expect_failure(source + "head --full -o x --regions-out r.pvd", 2, "--regions-out");
  expect_failure(source + "head --full -o x --components-out c.h5", 2, "--components-out");
  expect_failure(source + "head head -o x", 2, "x/head: two outputs");
  expect_failure(source + "head -k 2 -o x --regions-out r.json --weights-out r.json", 2,
                 "r.json: two outputs");
  expect_failure(source + "head -o ''", 2, "is empty");
  expect_failure("transfer '' head -o x", 2, "is empty");
}

TEST_F(ExitCode, Is2ForOptionsThatWeightsOfEachRegionDoNotFollow) {
  const std::string source = "transfer head --weights take.csv head -k 2 -o x ";
  expect_failure(source + "--outside-weight 0.3", 2,
                 "--outside-weight: is about --outside identity, or targets of other faces");
  expect_failure(source + "--outside fixed --outside-smoothness 1", 2, "--outside-smoothness: is");
  expect_failure(source + "--region-ridge 2", 2, "--region-ridge: is about weights of each");
  expect_failure(source + "--per-region --space vertex", 2, "head is solved for vertices");
  expect_failure(source + "--per-region --full", 2, "--per-region: there are no regions");
  expect_failure(source + "--per-region --smoothness 0.1", 2, "--smoothness: with --per-region");
  expect_failure(source + "--per-region --complete 0.2", 2, "--complete: with --per-region");
  expect_failure(source + "--per-region --region-ridge 0", 2, "--region-ridge: expected");
  expect_failure(source + "--per-region --falloff 12", 2, "12abs");
  expect_failure("evaluate head --weights take.csv head -k 2 --region-ridge 2", 2,
                 "--region-ridge: is about weights of each region");
}

TEST_F(ExitCode, Is3ForAMissingFileOfAnyOption) {
  expect_failure("transfer head --weights take.csv head --source-rest no.ply -o x", 3, "no.ply");
  expect_failure("decompose head --weights take.csv --rest no.ply -o c.h5", 3, "no.ply");
  expect_failure("decompose head --weights take.csv --align no.json -o c.h5", 3, "no.json");
}

TEST_F(ExitCode, Is4ForInputsThatContradictEachOtherOrTheRequest) {
  expect_failure("decompose head --weights take.csv -k 2 -o c.h5 --memory 1M", 4,
                 "--memory: what is left of it, 0 MB, does not hold a decomposition of 12 frames");
  write("small.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_failure("transfer head --weights take.csv small.obj --full -o x", 4,
                 "3 vertices, expected 225");
  std::string mask;
  for (int v = 0; v < 225; ++v) mask += "0\n";
  write("mask.txt", mask);
  expect_failure("transfer head --weights take.csv head --regions mask.txt --space vertex -o x", 4,
                 "no triangle");
}

TEST_F(ExitCode, Is2ForAnOptionThatNoFormatOfTheRunTakes) {
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o r.pvd").code, 0);
  expect_failure("info r.pvd --weights take.csv", 2, "'weights' is about files");
  expect_failure("info r.pvd --topology head/neutral.ply", 2, "'topology' is about files");
  expect_failure("info r.pvd --fps 30", 2,
                 "r.pvd: its 12 frames have times of their own, 0 to 0.44 s, and --fps is for what "
                 "has none");
  expect_failure("convert r.pvd -o r.npy --format obj", 2, "'format' is about files");
}

TEST_F(ExitCode, Is4ForAFileThatNoInputNeeds) {
  expect_failure("info head --weights take.csv --topology head/neutral.ply", 4,
                 "no input is an array");
}

TEST_F(ExitCode, Is4ForAnAnchorThatTheMeshDoesNotHave) {
  expect_failure("transfer head --weights take.csv head --space vertex --full --anchor 225 -o x", 4,
                 "vertex 225");
}

TEST_F(ExitCode, Is5ForTheOutputOfAnyTargetBeforeComputing) {
  std::filesystem::create_directories(folder_ / "x/head@wide=1");
  expect_failure("transfer head --weights take.csv head head@wide=1 -o x", 5, "head@wide=1");
}

TEST_F(ExitCode, Is5ForAnOutputThatExistsUnlessForced) {
  write("c.h5", "mine");
  expect_failure("decompose head --weights take.csv -k 2 -o c.h5", 5, "--force");
  EXPECT_EQ(text_of(folder_ / "c.h5"), "mine");
  EXPECT_EQ(run("decompose head --weights take.csv -k 2 -o c.h5 --force").code, 0);
  EXPECT_NE(text_of(folder_ / "c.h5"), "mine");
}

TEST_F(ExitCode, Is130WhenInterruptedAndNothingIsLeft) {
  const auto before = listing();
  // The second computes for ever between two looks at interrupts.
  for (const char* iterations : {"--iterations 1000000", "--admm-iterations 1000000000"}) {
    const std::string line = "cd '" + folder_.string() +
                             "' && timeout --preserve-status -s INT 1 " + MIMETRA_COMMAND +
                             " decompose head --weights take.csv -k 100 " + iterations +
                             " --tolerance 0 -o c.h5 2> /dev/null";
    const int status = std::system(line.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 130) << iterations;
    EXPECT_EQ(listing(), before) << iterations;
  }
}

}  // namespace
}  // namespace mimetra
