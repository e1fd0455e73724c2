#include "toolkit/cli/exit_code.h"

#include <gtest/gtest.h>

namespace mimetra::cli {
namespace {

TEST(TerminalText, KeepsLinesAndPrintableUtf8) {
  const std::string text = "br\u00e4ue_\u7b11.obj:\tframe 3\n";
  EXPECT_EQ(terminal_text(text), text);
}

TEST(TerminalText, ShowsWhatWouldActOnTheTerminal) {
  EXPECT_EQ(terminal_text("a\x1b[31m.obj"), "a\\x1b[31m.obj");
  EXPECT_EQ(terminal_text("a\r\x7f\b"), "a\\x0d\\x7f\\x08");
  EXPECT_EQ(terminal_text("\u009b31m"), "\\xc2\\x9b31m");
  EXPECT_EQ(terminal_text("\u202eply.exe"), "\\xe2\\x80\\xaeply.exe");
}

TEST(TerminalText, ShowsBytesThatAreNoUtf8) {
  EXPECT_EQ(terminal_text("br\xe4ue"), "br\\xe4ue");
  EXPECT_EQ(terminal_text("\xe7\xac"), "\\xe7\\xac");
  EXPECT_EQ(terminal_text("\xc0\x80"), "\\xc0\\x80");
  EXPECT_EQ(terminal_text("\xed\xa0\x80"), "\\xed\\xa0\\x80");
}

}  // namespace
}  // namespace mimetra::cli
