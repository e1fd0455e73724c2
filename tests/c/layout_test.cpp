// The layout of mimetra.h on 64-bit systems, and the symbols of the library: what programs that are
// compiled already rely on. Numbers here may be added to, never changed.

#include <array>
#include <cstdio>
#include <memory>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plugins/c/mimetra.h"

namespace {

TEST(Layout, OfArray) {
  EXPECT_EQ(sizeof(mimetra_array), 64u);
  EXPECT_EQ(offsetof(mimetra_array, struct_size), 0u);
  EXPECT_EQ(offsetof(mimetra_array, type), 4u);
  EXPECT_EQ(offsetof(mimetra_array, rank), 8u);
  EXPECT_EQ(offsetof(mimetra_array, location), 12u);
  EXPECT_EQ(offsetof(mimetra_array, shape), 16u);
  EXPECT_EQ(offsetof(mimetra_array, name), 48u);
  EXPECT_EQ(offsetof(mimetra_array, values), 56u);
}

TEST(Layout, OfPort) {
  EXPECT_EQ(sizeof(mimetra_port), 32u);
  EXPECT_EQ(offsetof(mimetra_port, struct_size), 0u);
  EXPECT_EQ(offsetof(mimetra_port, kind), 4u);
  EXPECT_EQ(offsetof(mimetra_port, name), 8u);
  EXPECT_EQ(offsetof(mimetra_port, help), 16u);
  EXPECT_EQ(offsetof(mimetra_port, flags), 24u);
  EXPECT_EQ(offsetof(mimetra_port, reserved), 28u);
}

TEST(Layout, OfParameter) {
  EXPECT_EQ(sizeof(mimetra_parameter), 72u);
  EXPECT_EQ(offsetof(mimetra_parameter, struct_size), 0u);
  EXPECT_EQ(offsetof(mimetra_parameter, kind), 4u);
  EXPECT_EQ(offsetof(mimetra_parameter, name), 8u);
  EXPECT_EQ(offsetof(mimetra_parameter, help), 16u);
  EXPECT_EQ(offsetof(mimetra_parameter, fallback), 24u);
  EXPECT_EQ(offsetof(mimetra_parameter, unit), 32u);
  EXPECT_EQ(offsetof(mimetra_parameter, minimum), 40u);
  EXPECT_EQ(offsetof(mimetra_parameter, maximum), 48u);
  EXPECT_EQ(offsetof(mimetra_parameter, choices), 56u);
  EXPECT_EQ(offsetof(mimetra_parameter, of_files), 64u);
  EXPECT_EQ(offsetof(mimetra_parameter, reserved), 68u);
}

TEST(Layout, OfOperation) {
  EXPECT_EQ(sizeof(mimetra_operation), 72u);
  EXPECT_EQ(offsetof(mimetra_operation, struct_size), 0u);
  EXPECT_EQ(offsetof(mimetra_operation, reserved), 4u);
  EXPECT_EQ(offsetof(mimetra_operation, name), 8u);
  EXPECT_EQ(offsetof(mimetra_operation, summary), 16u);
  EXPECT_EQ(offsetof(mimetra_operation, inputs), 24u);
  EXPECT_EQ(offsetof(mimetra_operation, outputs), 32u);
  EXPECT_EQ(offsetof(mimetra_operation, parameters), 40u);
  EXPECT_EQ(offsetof(mimetra_operation, examples), 48u);
  EXPECT_EQ(offsetof(mimetra_operation, run), 56u);
  EXPECT_EQ(offsetof(mimetra_operation, user), 64u);
}

TEST(Layout, OfPlugin) {
  EXPECT_EQ(sizeof(mimetra_plugin), 32u);
  EXPECT_EQ(offsetof(mimetra_plugin, struct_size), 0u);
  EXPECT_EQ(offsetof(mimetra_plugin, version), 4u);
  EXPECT_EQ(offsetof(mimetra_plugin, name), 8u);
  EXPECT_EQ(offsetof(mimetra_plugin, operations), 16u);
  EXPECT_EQ(offsetof(mimetra_plugin, formats), 24u);
}

TEST(Layout, OfFormat) {
  EXPECT_EQ(sizeof(mimetra_format), 64u);
  EXPECT_EQ(offsetof(mimetra_format, struct_size), 0u);
  EXPECT_EQ(offsetof(mimetra_format, kind), 4u);
  EXPECT_EQ(offsetof(mimetra_format, name), 8u);
  EXPECT_EQ(offsetof(mimetra_format, extensions), 16u);
  EXPECT_EQ(offsetof(mimetra_format, parameters), 24u);
  EXPECT_EQ(offsetof(mimetra_format, read), 32u);
  EXPECT_EQ(offsetof(mimetra_format, write), 40u);
  EXPECT_EQ(offsetof(mimetra_format, user), 48u);
  EXPECT_EQ(offsetof(mimetra_format, flags), 56u);
  EXPECT_EQ(offsetof(mimetra_format, use), 60u);
}

TEST(Layout, OfInterface) {
  EXPECT_EQ(offsetof(mimetra_interface, struct_size), 0u);
  EXPECT_EQ(offsetof(mimetra_interface, version), 4u);
  EXPECT_EQ(offsetof(mimetra_interface, toolkit_version), 8u);
  // Functions follow one another, a pointer each, in this order.
  std::size_t offset = 16;
#define FOLLOWS(function)                                   \
  EXPECT_EQ(offsetof(mimetra_interface, function), offset); \
  offset += 8
  FOLLOWS(new_context);
  FOLLOWS(free_context);
  FOLLOWS(message);
  FOLLOWS(set_progress);
  FOLLOWS(set_threads);
  FOLLOWS(operations);
  FOLLOWS(find_operation);
  FOLLOWS(operations_json);
  FOLLOWS(new_data);
  FOLLOWS(derive_data);
  FOLLOWS(load_data);
  FOLLOWS(save_data);
  FOLLOWS(free_data);
  FOLLOWS(data_kind);
  FOLLOWS(data_name);
  FOLLOWS(data_arrays);
  FOLLOWS(data_array);
  FOLLOWS(data_json);
  FOLLOWS(new_call);
  FOLLOWS(free_call);
  FOLLOWS(call_set);
  FOLLOWS(call_give);
  FOLLOWS(call_read);
  FOLLOWS(call_want);
  FOLLOWS(call_write);
  FOLLOWS(call_run);
  FOLLOWS(call_output_count);
  FOLLOWS(call_output);
  FOLLOWS(call_report);
  FOLLOWS(call_summary);
  FOLLOWS(job_context);
  FOLLOWS(job_input);
  FOLLOWS(job_number);
  FOLLOWS(job_text);
  FOLLOWS(job_threads);
  FOLLOWS(job_wants);
  FOLLOWS(job_progress);
  FOLLOWS(job_log);
  FOLLOWS(job_fail);
  FOLLOWS(job_output);
  FOLLOWS(job_report);
  FOLLOWS(formats);
#undef FOLLOWS
  EXPECT_EQ(sizeof(mimetra_interface), offset);
}

TEST(Words, KeepTheirNumbers) {
  EXPECT_THAT((std::array{MIMETRA_OK, MIMETRA_FAILED, MIMETRA_USAGE, MIMETRA_BAD_INPUT,
                          MIMETRA_MISMATCH, MIMETRA_BAD_OUTPUT, MIMETRA_CANCELLED}),
              testing::ElementsAre(0, 1, 2, 3, 4, 5, 130));
  EXPECT_THAT((std::array{MIMETRA_SEQUENCE, MIMETRA_MODEL, MIMETRA_COMPONENTS, MIMETRA_REGIONS,
                          MIMETRA_TABLE, MIMETRA_LANDMARKS, MIMETRA_FIT, MIMETRA_PICTURES,
                          MIMETRA_DOCUMENT}),
              testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_THAT((std::array{MIMETRA_FLAG, MIMETRA_INTEGER, MIMETRA_INTEGER_LIST, MIMETRA_NUMBER,
                          MIMETRA_LENGTH, MIMETRA_CHOICE, MIMETRA_TEXT, MIMETRA_FILE}),
              testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT((std::array{MIMETRA_F64, MIMETRA_F32, MIMETRA_I32, MIMETRA_U8, MIMETRA_STRING}),
              testing::ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT((std::array{MIMETRA_NOWHERE, MIMETRA_ON_VERTICES, MIMETRA_ON_TRIANGLES}),
              testing::ElementsAre(0, 1, 2));
  EXPECT_THAT((std::array{MIMETRA_OPTIONAL, MIMETRA_REPEATED, MIMETRA_NAMED, MIMETRA_WITH_FIELDS}),
              testing::ElementsAre(1, 2, 4, 8));
}

/// What a shell command prints, line by line.
std::multiset<std::string> lines_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::multiset<std::string> lines;
  std::array<char, 1000> line;
  while (std::fgets(line.data(), line.size(), pipe.get())) {
    lines.insert(std::string(line.data(), std::string(line.data()).find('\n')));
  }
  return lines;
}

TEST(Library, ShowsOneSymbol) {
  EXPECT_THAT(lines_of("nm -D --defined-only --format=just-symbols " MIMETRA_C_LIBRARY),
              testing::ElementsAre("mimetra_get_interface"));
}

TEST(Library, NeedsNoVtk) {
  const auto needed = lines_of("ldd " MIMETRA_C_LIBRARY);
  EXPECT_THAT(needed, testing::Contains(testing::HasSubstr("libzip")));
  EXPECT_THAT(needed, testing::Not(testing::Contains(testing::HasSubstr("libvtk"))));
}

}  // namespace
