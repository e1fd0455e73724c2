#include <sys/resource.h>
#include <csignal>

#include <gmock/gmock.h>

#include "tests/vtk/vtp_fixture.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

using VtpErrors = VtpTest;

/// Files cannot grow beyond a size, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_;
  void (*handler_)(int);
};

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

TEST_F(VtpErrors, AnExistingSeriesIsRefusedAndStaysAsItIs) {
  write_text(in_folder("face.pvd"), "mine");
  EXPECT_THAT([&] { write_vtp_series(quad_and_triangle(), in_folder("face.pvd")); },
              ThrowsMessage<OutputError>(StartsWith(in_folder("face.pvd").string())));
  EXPECT_EQ(bytes_of(in_folder("face.pvd")), "mine");
  EXPECT_FALSE(std::filesystem::exists(in_folder("face_vtp")));
}

TEST_F(VtpErrors, AnExistingFolderOfFramesIsRefused) {
  std::filesystem::create_directories(in_folder("face_vtp"));
  EXPECT_THROW(write_vtp_series(quad_and_triangle(), in_folder("face.pvd")), OutputError);
  EXPECT_FALSE(std::filesystem::exists(in_folder("face.pvd")));
}

TEST_F(VtpErrors, AnExistingSeriesIsReplacedWhenAsked) {
  write_vtp_series(quad_and_triangle(), in_folder("face.pvd"));
  FieldSequence shorter = quad_and_triangle();
  shorter.frames = std::make_shared<const MeshSequence>(shorter.sequence().slice(0, 1));
  write_vtp_series(shorter, in_folder("face.pvd"), {.overwrite = true});
  EXPECT_TRUE(std::filesystem::exists(in_folder("face_vtp/face_0000.vtp")));
  EXPECT_FALSE(std::filesystem::exists(in_folder("face_vtp/face_0001.vtp")));
}

TEST_F(VtpErrors, AFolderThatCannotBeMadeIsAnOutputErrorAndLeavesNothing) {
  write_text(in_folder("file"), "in the way");
  EXPECT_THROW(write_vtp_series(quad_and_triangle(), in_folder("file/face.pvd")), OutputError);
  EXPECT_EQ(bytes_of(in_folder("file")), "in the way");
}

TEST_F(VtpErrors, AFullDiskIsAnOutputErrorAndLeavesNothing) {
  FieldSequence fields = quad_and_triangle();
  {
    const FileSizeLimit limit(1000);  // the index files fit, a frame of some 3 kB does not
    EXPECT_THAT(
        [&] { write_vtp_series(fields, in_folder("face.pvd")); },
        ThrowsMessage<OutputError>(StartsWith(in_folder("face_vtp/face_0000.vtp").string())));
  }
  EXPECT_TRUE(folder_is_empty());
}

TEST_F(VtpErrors, ANameThatXmlCannotHoldIsRefused) {
  for (const std::string name : {"a\nb.pvd", "a\x01.pvd", "br\xe4ue.pvd"}) {
    EXPECT_THAT([&] { write_vtp_series(quad_and_triangle(), in_folder(name)); },
                ThrowsMessage<OutputError>(HasSubstr("choose another")));
    EXPECT_FALSE(std::filesystem::exists(in_folder(name)));
  }
  write_vtp_series(quad_and_triangle(), in_folder("<a> & \"b's\" \u7b11.pvd"));
  EXPECT_EQ(read_vtp_series(in_folder("<a> & \"b's\" \u7b11.pvd")).sequence().frames(),
            quad_and_triangle().frames->frames());
}

TEST_F(VtpErrors, ACancelledSeriesLeavesNothing) {
  const auto stop_at_half = [](double share) { return share < 0.5; };
  EXPECT_THROW(write_vtp_series(quad_and_triangle(), in_folder("face.pvd"), {},
                                Context().with_progress(stop_at_half)),
               Cancelled);
  EXPECT_TRUE(folder_is_empty());
}

TEST_F(VtpErrors, FieldsAndTargetsThatCannotBeWrittenAreNamed) {
  const auto refusal = [this](const FieldSequence& fields, const char* name = "face.pvd") {
    return message_of<std::invalid_argument>([&] { write_vtp_series(fields, in_folder(name)); });
  };
  FieldSequence shorter = quad_and_triangle(), twice = quad_and_triangle();
  shorter.fields[0].values = Eigen::VectorXd::Zero(4);
  EXPECT_THAT(refusal(shorter),
              AllOf(HasSubstr("'region'"), HasSubstr("4 x 1"), HasSubstr("expected 5")));
  twice.fields[1].name = "region";
  EXPECT_THAT(refusal(twice), HasSubstr("'region' occurs twice"));
  EXPECT_THAT(refusal(quad_and_triangle(), "face.obj"), HasSubstr(".pvd or .vtp"));
}

TEST_F(VtpErrors, WhatCannotBeReadIsNamed) {
  const auto refusal = [this](const std::string& name) {
    return message_of<IoError>([&] { read_vtp_field(in_folder(name), "roi"); });
  };
  EXPECT_THAT(refusal("none.vtp"), StartsWith(in_folder("none.vtp").string()));
  EXPECT_THAT(refusal(""), HasSubstr("is a folder"));
  write_vtp_series(quad_and_triangle(), in_folder("face.vtp"));
  EXPECT_THAT(refusal("face.vtp"), AllOf(HasSubstr("'roi'"), HasSubstr("region, direction")));
  write_text(in_folder("appended.vtp"),
             "<VTKFile type=\"PolyData\"><AppendedData encoding=\"raw\">");
  EXPECT_THAT(refusal("appended.vtp"), HasSubstr("has no points"));
}

TEST_F(VtpErrors, EveryTruncatedPrefixIsAnIoErrorAndPrintsNothing) {
  write_vtp_series(quad_and_triangle(), in_folder("face.vtp"));
  const std::string whole = bytes_of(in_folder("face.vtp"));
  const std::size_t end = whole.rfind("</VTKFile>");
  ::testing::internal::CaptureStderr();
  for (std::size_t size = 0; size < end; size += 7) {
    write_text(in_folder("cut.vtp"), whole.substr(0, size));
    EXPECT_THROW(read_vtp_field(in_folder("cut.vtp"), "displacement_length"), IoError) << size;
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace mimetra::test
