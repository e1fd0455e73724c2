// Formats: sound ones of kinds of values, and some that do something wrong.

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <string>

#include "plugins/c/mimetra.h"

namespace {

constexpr int kRead = MIMETRA_READING, kWrite = MIMETRA_WRITING;

/// One vertex in a region of a mesh of as many vertices as the option says.
mimetra_status read_regions(const mimetra_interface* m, mimetra_job* job, void*) {
  const auto vertices = static_cast<std::int64_t>(m->job_number(job, "vertices"));
  std::string inside(static_cast<std::size_t>(vertices), '\0');
  inside[0] = 1;
  const std::int32_t corners[] = {0, 1, 2};
  const mimetra_array masks = {sizeof masks, MIMETRA_U8,   2, 0, {1, vertices, 0, 0},
                               "masks",      inside.data()};
  const mimetra_array triangles = {sizeof triangles, MIMETRA_I32, 2,      0,
                                   {1, 3, 0, 0},     "triangles", corners};
  const mimetra_array* const arrays[] = {&masks, &triangles, nullptr};
  mimetra_data* value = nullptr;
  mimetra_status status = m->new_data(m->job_context(job), MIMETRA_REGIONS, "one", arrays, &value);
  if (status == MIMETRA_OK) status = m->job_output(job, "value", value);
  m->free_data(value);
  m->job_log(job, MIMETRA_WARNING, "a note");
  return status;
}

/// "rows x columns", and the option.
mimetra_status write_table(const mimetra_interface* m, mimetra_job* job, void*) {
  const mimetra_array* const* arrays = nullptr;
  const mimetra_data* value = m->job_input(job, "value", 0);
  if (m->data_arrays(m->job_context(job), value, &arrays) != MIMETRA_OK) return MIMETRA_FAILED;
  int columns = 0;
  while (arrays[columns]) ++columns;
  std::FILE* file = std::fopen(m->job_text(job, "path"), "w");
  if (!file) return MIMETRA_BAD_OUTPUT;
  std::fprintf(file, "%d x %d %s\n", static_cast<int>(arrays[0]->shape[0]), columns,
               m->job_text(job, "title"));
  return std::fclose(file) ? MIMETRA_BAD_OUTPUT : MIMETRA_OK;
}

mimetra_status nothing(const mimetra_interface*, mimetra_job*, void*) {
  return MIMETRA_OK;
}

mimetra_status throws(const mimetra_interface*, mimetra_job*, void*) {
  throw std::runtime_error("a bad day");
}

mimetra_status half(const mimetra_interface* m, mimetra_job* job, void*) {
  std::FILE* file = std::fopen(m->job_text(job, "path"), "w");
  if (file) {
    std::fputs("half", file);
    std::fclose(file);
  }
  return m->job_fail(job, MIMETRA_MISMATCH, "only half of it fits");
}

mimetra_parameter option(const char* name, std::uint32_t of_files) {
  mimetra_parameter made{};
  made.struct_size = sizeof made;
  made.kind = MIMETRA_TEXT;
  made.name = name;
  made.fallback = "none";
  made.of_files = of_files;
  return made;
}

/// A list of one option.
struct Options {
  mimetra_parameter parameter;
  const mimetra_parameter* list[2];

  explicit Options(const mimetra_parameter& only) : parameter(only), list{&parameter, nullptr} {}
};

mimetra_format format(mimetra_kind kind, const char* name, const char* const* extensions,
                      mimetra_run read, mimetra_run write) {
  mimetra_format made{};
  made.struct_size = sizeof made;
  made.kind = kind;
  made.name = name;
  made.extensions = extensions;
  made.read = read;
  made.write = write;
  return made;
}

#define EXTENSION(name, text) const char* const name[] = {text, nullptr}
EXTENSION(kRegions, ".spot");
EXTENSION(kTable, ".count");
EXTENSION(kNothing, ".none");
EXTENSION(kThrows, ".throws");
EXTENSION(kHalf, ".half");
EXTENSION(kNoDot, "mesh");
EXTENSION(kCapitals, ".MESH");
EXTENSION(kTaken, ".npy");
EXTENSION(kFree, ".free");

}  // namespace

const mimetra_plugin* mimetra_get_plugin() {
  static mimetra_parameter count = option("vertices", kRead);
  count.kind = MIMETRA_INTEGER;
  count.fallback = "25";
  static const Options vertices(count), title(option("title", kWrite)), path(option("path", kRead)),
      own(option("k", kRead)), neither(option("aim", 0));
  static mimetra_format all[] = {
      format(MIMETRA_REGIONS, "one spot", kRegions, read_regions, nullptr),
      format(MIMETRA_TABLE, "size of a table", kTable, nullptr, write_table),
      format(MIMETRA_SEQUENCE, "nothing", kNothing, nothing, nothing),
      format(MIMETRA_SEQUENCE, "throws", kThrows, throws, throws),
      format(MIMETRA_SEQUENCE, "half", kHalf, nullptr, half),
      format(MIMETRA_SEQUENCE, nullptr, kFree, nothing, nullptr),
      format(99, "of no kind", kFree, nothing, nullptr),
      format(MIMETRA_SEQUENCE, "no extension", nullptr, nothing, nullptr),
      format(MIMETRA_SEQUENCE, "no dot", kNoDot, nothing, nullptr),
      format(MIMETRA_SEQUENCE, "capitals", kCapitals, nothing, nullptr),
      format(MIMETRA_SEQUENCE, "taken", kTaken, nothing, nullptr),
      format(MIMETRA_SEQUENCE, "no function", kFree, nullptr, nullptr),
      format(MIMETRA_SEQUENCE, "path", kFree, nothing, nullptr),
      format(MIMETRA_SEQUENCE, "of an operation", kFree, nothing, nullptr),
      format(MIMETRA_SEQUENCE, "neither", kFree, nothing, nullptr)};
  all[0].parameters = vertices.list;
  all[1].parameters = title.list;
  all[12].parameters = path.list;
  all[13].parameters = own.list;
  all[14].parameters = neither.list;
  static const mimetra_format* formats[std::size(all) + 1] = {};
  for (std::size_t i = 0; i < std::size(all); ++i) formats[i] = &all[i];
  static const mimetra_plugin plugin = {sizeof plugin, MIMETRA_INTERFACE_VERSION, "formats",
                                        nullptr, formats};
  return &plugin;
}
