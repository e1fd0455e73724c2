#include "toolkit/operations/option_words.h"

#include <gtest/gtest.h>

namespace mimetra {
namespace {

std::string command(const std::string& message) {
  return with_options_spelled(message, spelled_for_command);
}

std::string library(const std::string& message) {
  return with_options_spelled(message, spelled_for_library);
}

TEST(OptionWords, AreThoseOfTheHost) {
  EXPECT_EQ(command("exists already; use option 'overwrite' to replace it"),
            "exists already; use --force to replace it");
  EXPECT_EQ(command("take more regions (-k, --radius) or option 'full'"),
            "take more regions (-k, --radius) or --full");
  EXPECT_EQ(library("take more regions (-k, --radius) or --full"),
            "take more regions (option 'k', option 'radius') or option 'full'");
  EXPECT_EQ(command("--l1: no weights"), "--l1: no weights");
  EXPECT_EQ(library("--l1: no weights"), "option 'l1': no weights");
  EXPECT_EQ(library("--source-rest: vertex 3"), "option 'source-rest': vertex 3");
  EXPECT_EQ(library("use --force; write -o NAME"),
            "use option 'overwrite'; write option 'out' NAME");
}

TEST(OptionWords, LeaveUnknownOptionsAsTheyWereTyped) {
  const std::string typed = "transfer: unknown option --overwrite; there is --force";
  EXPECT_EQ(command(typed), typed);
  EXPECT_EQ(library("x: unknown option --force; see --out"),
            "x: unknown option --force; see option 'out'");
}

TEST(OptionWords, AreNotSeenInOtherText) {
  for (const std::string text : {"a -- b", "take--7.obj", "at -3.5 and -1e-3", "x-k", "- k", "-",
                                 "option 'Mine'", "option '", "--", "well-known", "---"}) {
    EXPECT_EQ(library(text), text);
    EXPECT_EQ(command(text), text);
  }
}

}  // namespace
}  // namespace mimetra
