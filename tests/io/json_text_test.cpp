#include "toolkit/io/json_text.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::message_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string refusal_of(const std::string& text) {
  return message_of<IoError>([&] { parse_json("a.json", text); });
}

std::string nested(std::size_t levels) {
  return std::string(levels, '[') + std::string(levels, ']');
}

TEST(JsonText, ComesBackAfterWritingWithItsKeysInTheirOrder) {
  const Json json = {{"z", 1}, {"a", {1.5, nullptr, true}}, {"name", "Br\u00e4ue"}};
  for (const int indent : {-1, 2}) EXPECT_EQ(parse_json("a.json", json_text(json, indent)), json);
}

TEST(JsonText, MayHaveAByteOrderMark) {
  EXPECT_EQ(parse_json("a.json", "\xEF\xBB\xBF[1]"), Json({1}));
}

TEST(JsonText, ErrorsNameThePathTheLineAndWhatWasExpected) {
  EXPECT_THAT(refusal_of("{\"k\":\n 3"), StartsWith("a.json: expected JSON: line 2"));
  EXPECT_THAT(message_of<IoError>([] { parse_json("a.json", "{", "a list of names"); }),
              StartsWith("a.json: expected a list of names: line 1"));
}

TEST(JsonText, EveryTruncatedPrefixIsAnError) {
  const std::string text = R"({"a": [1.5, "x", {"b": null}], "c": true})";
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_THROW(parse_json("a.json", text.substr(0, size)), IoError) << size;
  }
}

TEST(JsonText, DeepNestingIsAnErrorAndNotAFullStack) {
  EXPECT_NO_THROW(parse_json("a.json", nested(100)));
  for (const std::size_t levels : {std::size_t{101}, std::size_t{5'000'000}}) {
    EXPECT_THAT(refusal_of(nested(levels)), HasSubstr("deeper than 100"));
    EXPECT_THAT(refusal_of(std::string(levels, '[')), HasSubstr("deeper than 100"));
  }
}

TEST(JsonText, AKeyThatOccursTwiceInAnObjectIsNamed) {
  EXPECT_THAT(refusal_of(R"({"k": 3, "k": 4})"), HasSubstr("'k' occurs twice"));
  EXPECT_NO_THROW(parse_json("a.json", R"({"k": {"k": 1}, "m": {"k": 1}})"));
}

TEST(JsonText, MoreKeysThanAreComparedInTimeAreRefused) {
  std::string text = "{";
  for (int key = 0; key <= 10000; ++key) {
    text += (key > 0 ? ",\"" : "\"") + std::to_string(key) + "\":0";
  }
  EXPECT_THAT(refusal_of(text + '}'), HasSubstr("more than 10000 keys"));
}

TEST(JsonText, ZeroBytesInStringsAreRefused) {
  EXPECT_THAT(refusal_of(R"(["smile\u0000.obj"])"), AllOf(HasSubstr("'smile'"), HasSubstr("zero")));
  EXPECT_THAT(refusal_of(R"({"smile\u0000": 1})"), HasSubstr("zero"));
}

TEST(JsonText, NumbersBeyondAllDoublesAndBytesThatAreNoUtf8AreRefused) {
  EXPECT_THAT(refusal_of("[1e999]"), HasSubstr("1e999"));
  EXPECT_THROW(parse_json("a.json", "[\"\xff\"]"), IoError);
}

TEST(JsonText, LongWordsOfOthersDoNotFillTheMessage) {
  EXPECT_LT(refusal_of("[" + std::string(100000, 'x') + "]").size(), 300u);
  EXPECT_EQ(short_text(Json(std::string(1000, 'x'))).size(), 43u);
  EXPECT_EQ(short_text(parse_json("a.json", nested(100))), "a list");
}

TEST(JsonText, NamesThatAreNoUtf8AreWrittenWithAReplacement) {
  const std::string text = json_text(Json{{"name", "br\xe4ue"}});
  EXPECT_EQ(parse_json("a.json", text).at("name").get<std::string>(), "br\uFFFDue");
}

TEST(JsonText, IsNoneWhereThereIsNoFileOrNoJsonInIt) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.json") << "{\"k\": 1}";
  std::ofstream(folder / "b.json") << "{\"k\": ";
  EXPECT_EQ(read_json_if_any(folder / "a.json").value().at("k"), 1);
  EXPECT_FALSE(read_json_if_any(folder / "b.json"));
  EXPECT_FALSE(read_json_if_any(folder / "c.json"));
  EXPECT_FALSE(read_json_if_any(folder.path()));
}

}  // namespace
}  // namespace mimetra
