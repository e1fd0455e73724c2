#include <algorithm>
#include <functional>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/command_fixture.h"
#include "tests/test_folders.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAreArray;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// Where operations can be run from: its tests, and how one of these runs an operation, whose name
/// there is the table's, or what the document calls it.
struct Host {
  std::string name;
  std::string tests;
  std::function<std::string(const std::string& operation, const std::string& shown)> call;
};

std::vector<Host> hosts() {
  const auto in_python = [](const std::string& operation) { return replaced(operation, "-", "_"); };
  return {{"command", "tests/cli",
           [](const std::string& operation, const std::string&) {
             return "\"" + operation + "[ \"\\\\]";
           }},
          {"C", "tests/c",
           [](const std::string& operation, const std::string&) {
             return "(new_call\\(|call_on\\(m, )context,\\s+\"" + operation + "\"";
           }},
          {"Python", "tests/python",
           [in_python](const std::string& operation, const std::string&) {
             return "mimetra\\." + in_python(operation) + "\\(";
           }},
          {"Blender", "tests/blender",
           [in_python](const std::string& operation, const std::string&) {
             return "bpy\\.ops\\.mimetra\\." + in_python(operation) + "\\(";
           }},
          {"ParaView", "tests/paraview",
           [](const std::string&, const std::string& shown) {
             return "simple\\." + replaced(shown, " ", "") + "\\(";
           }},
          {"MeshLab", "tests/meshlab", [](const std::string&, const std::string& shown) {
             return "filter_script\\(\\s*\"" + shown + "\"";
           }}};
}

/// The cells of a line of a Markdown table, without blanks around them.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream rest(line.substr(1));
  for (std::string cell; std::getline(rest, cell, '|');) {
    const auto begin = cell.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    cells.push_back(cell.substr(begin, cell.find_last_not_of(' ') - begin + 1));
  }
  return cells;
}

/// "(2)" is the reason 2 for which a host does not have an operation; anything else says it has.
bool is_absent(const std::string& cell) {
  return cell.starts_with('(');
}

/// The table of operations and hosts in docs/plugins.md, and the reasons below it.
class HostTable : public test::CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    std::stringstream document(text_of(test::source_folder() / "docs/plugins.md"));
    bool in_table = false;
    for (std::string line; std::getline(document, line);) {
      std::smatch reason;
      if (line.starts_with("| operation |")) heads_ = cells_of(line);
      in_table = line.starts_with('|') && (in_table || line.starts_with("| operation |"));
      if (in_table && line.starts_with("| `")) {
        rows_.push_back(cells_of(line));
        rows_.back().front() = replaced(rows_.back().front(), "`", "");
      }
      if (std::regex_search(line, reason, std::regex("^([0-9]+)\\. "))) {
        reasons_.insert("(" + reason[1].str() + ")");
      }
    }
  }

  /// All sources in a folder of tests, one after the other.
  static std::string sources_of(const fs::path& folder) {
    const std::set<std::string> extensions = {".py", ".c", ".cpp", ".h"};
    std::string text;
    for (const auto& file : fs::recursive_directory_iterator(test::source_folder() / folder)) {
      if (extensions.contains(file.path().extension())) text += text_of(file.path());
    }
    return text;
  }

  std::vector<std::string> heads_;
  std::vector<std::vector<std::string>> rows_;
  std::set<std::string> reasons_;
};

TEST_F(HostTable, HasARowForEachOperationAndAColumnForEachHost) {
  std::vector<std::string> operations, named;
  const auto listing = nlohmann::json::parse(run("operations --json").out);
  for (const auto& operation : listing.at("operations")) {
    operations.push_back(operation.at("name"));
  }
  std::vector<std::string> heads = {"operation"};
  for (const Host& host : hosts()) heads.push_back(host.name);
  EXPECT_EQ(heads_, heads);
  for (const auto& row : rows_) {
    EXPECT_EQ(row.size(), heads.size()) << row.front();
    named.push_back(row.front());
  }
  EXPECT_THAT(named, ElementsAreArray(operations));
}

TEST_F(HostTable, ClaimsWhatATestOfTheHostRuns) {
  std::size_t column = 1;
  for (const Host& host : hosts()) {
    const std::string sources = sources_of(host.tests);
    for (const auto& row : rows_) {
      const std::string& shown = row.at(column);
      if (is_absent(shown)) continue;
      const std::regex call(host.call(row.front(), shown));
      EXPECT_TRUE(std::regex_search(sources, call))
          << "no test in " << host.tests << " runs " << row.front();
    }
    ++column;
  }
}

TEST_F(HostTable, SaysWhyAHostDoesNotHaveAnOperation) {
  std::set<std::string> used;
  for (const auto& row : rows_) {
    std::ranges::copy_if(row, std::inserter(used, used.end()), is_absent);
  }
  EXPECT_EQ(used, reasons_);
}

}  // namespace
}  // namespace mimetra
