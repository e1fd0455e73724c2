#include "tests/fuzz/fuzz_target.h"

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include <unistd.h>

#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::fuzz {

std::function<void(const fs::path& file)> text(std::string content) {
  return [content = std::move(content)](const fs::path& file) { write_bytes(file, content); };
}

namespace {

std::vector<Target> all_targets() {
  std::vector<Target> all;
  for (auto& part : {format_targets(), model_targets(), text_targets(), interface_targets()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

/// In memory, and gone with the process.
const fs::path& own_folder() {
  static const fs::path folder = [] {
    fs::path made = "/dev/shm/mimetra_fuzz_" + std::to_string(getpid());
    fs::create_directories(made);
    std::atexit([] { fs::remove_all(own_folder()); });
    return made;
  }();
  return folder;
}

void write_seeds(const Target& target, const fs::path& folder) {
  fs::create_directories(folder);
  const fs::path made = own_folder() / target.name;
  for (std::size_t i = 0; i < target.seeds.size(); ++i) {
    fs::create_directories(made);
    target.seeds[i](made / target.file);
    target.read(made / target.file);  // what is thrown here is a seed that is not sound
    fs::copy_file(made / target.file, folder / (std::to_string(i) + "_" + target.file),
                  fs::copy_options::overwrite_existing);
    fs::remove_all(made);
  }
}

/// `--list` prints the targets; `--seeds FOLDER` writes sound files of each into its folder.
void serve(const std::vector<std::string>& arguments) {
  if (arguments.size() > 1 && arguments[1] == "--list") {
    for (const Target& target : all_targets()) std::cout << target.name << '\n';
    std::exit(0);
  }
  if (arguments.size() > 2 && arguments[1] == "--seeds") {
    for (const Target& target : all_targets()) {
      write_seeds(target, fs::path(arguments[2]) / target.name);
    }
    std::exit(0);
  }
}

/// The one that FUZZ_TARGET names.
Target chosen_target() {
  const char* name = std::getenv("FUZZ_TARGET");
  for (const Target& target : all_targets()) {
    if (!name || target.name != name) continue;
    for (const auto& seed : target.seeds) seed(own_folder() / target.file);
    return target;
  }
  std::cerr << "mimetra_fuzz: set FUZZ_TARGET to one of those that --list prints\n";
  std::exit(2);
}

}  // namespace

}  // namespace mimetra::fuzz

/// dlib forgets a few bytes of each JPEG that it cannot decode.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:dlib::jpeg_loader::read_image\n";
}

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  mimetra::fuzz::serve({*arguments, *arguments + *count});
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace mimetra;
  static const fuzz::Target target = fuzz::chosen_target();
  static const std::filesystem::path file = fuzz::own_folder() / target.file;
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  try {
    target.read(file);
  } catch (const IoError&) {
    return 0;
  } catch (const std::invalid_argument&) {
    return 0;
  }
  return 0;
}
