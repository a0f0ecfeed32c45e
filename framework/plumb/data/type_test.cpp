#include "plumb/data/type.hpp"

#include <gmock/gmock.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/data/toy_testing.hpp"

namespace plumb {
namespace {

/// Has what every type must have.
struct Plain {
  std::int32_t number = 0;
};
/// Says how its memory is laid out, and what may be built on it.
struct Indexed {
  std::vector<float> values;
};
/// Two that two modules give one name.
struct Narrow {
  std::int32_t number = 0;
};
struct Wide {
  double number = 0;
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Indexed>
void fields(Archive& a, T& value) { a(value.values); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Plain> ||
    std::is_same_v<std::remove_const_t<T>, Narrow> || std::is_same_v<std::remove_const_t<T>, Wide>
void fields(Archive& a, T& value) { a(value.number); }

}  // namespace

template <>
struct TypeTraits<Plain> {
  static constexpr const char* name = "test.Plain";
  static constexpr int version = 3;
};
template <>
struct TypeTraits<Indexed> {
  static constexpr const char* name = "test.Indexed";
  static constexpr int version = 1;
  static std::size_t extra_bytes(const Indexed& value) { return 100 * value.values.size(); }
  static std::string layout() { return "index 7"; }
};
template <>
struct TypeTraits<Narrow> {
  static constexpr const char* name = "test.Twin";
  static constexpr int version = 1;
};
template <>
struct TypeTraits<Wide> : TypeTraits<Narrow> {};

namespace {

using io::refusal;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::StartsWith;

/// What is said when a type is defined as `here` after it was defined as `there`.
std::string told(const Type& there, const Type& here) {
  define_type(there);
  return refusal([&] { define_type(here); });
}

TEST(ItemKind, MayBeDefinedTwiceAlike) {
  const ItemKind kind = {
      .name = "test.reel", .parts = "frame", .ranges = "test.Cut", .transient = true};
  const ItemKind& first = define_kind(kind);
  EXPECT_EQ(first, kind);
  EXPECT_EQ(&define_kind(kind), &first);
  EXPECT_EQ(find_kind("test.reel"), &first);
  EXPECT_EQ(find_kind("test.reels"), nullptr);
}

TEST(ItemKind, IsNotDefinedTwiceAndNotAlike) {
  const ItemKind kind = {.name = "test.joint"};
  const ItemKind& first = define_kind(kind);
  const ItemKind others[] = {{.name = "test.joint", .parts = "frame"},
                             {.name = "test.joint", .ranges = "test.Cut"},
                             {.name = "test.joint", .ends = "segment"},
                             {.name = "test.joint", .list = "test.Cut"},
                             {.name = "test.joint", .transient = true}};
  for (const ItemKind& other : others)
    EXPECT_EQ(refusal([&] { define_kind(other); }),
              "item kind 'test.joint' is defined twice, and not alike; give one of the two another "
              "name");
  EXPECT_EQ(first, kind);
}

TEST(Type, MayBeDefinedTwiceAlike) {
  const Type type = {.name = "test.Alike",
                     .version = 2,
                     .kind = &define_kind(toy::segment_kind()),
                     .large = true,
                     .layout = "8/8"};
  const Type& first = define_type(type);
  EXPECT_EQ(&define_type(type), &first);
  EXPECT_EQ(find_type("test.Alike"), &first);
  EXPECT_EQ(find_type("test.Unlike"), nullptr);
  EXPECT_EQ(first.version, 2);
  EXPECT_EQ(first.kind, find_kind("segment"));
  EXPECT_TRUE(first.large);
}

TEST(Type, IsNotDefinedTwiceWithAnotherVersion) {
  EXPECT_EQ(told({.name = "test.Versions"}, {.name = "test.Versions", .version = 2}),
            "type 'test.Versions' is defined twice, and not alike: its version is 1 there and 2 "
            "here; build both modules with the same header, or give one of the types another name");
  EXPECT_EQ(find_type("test.Versions")->version, 1);
}

TEST(Type, IsNotDefinedTwiceForOtherItems) {
  const ItemKind *frame = &define_kind(toy::frame_kind()),
                 *segment = &define_kind(toy::segment_kind());
  const Type there = {.name = "test.Items", .kind = frame};
  EXPECT_THAT(told(there, {.name = "test.Items"}),
              HasSubstr("one per frame there and one for the whole pipeline here"));
  EXPECT_THAT(told(there, {.name = "test.Items", .kind = segment}),
              HasSubstr("one per frame there and one per segment here"));
  EXPECT_EQ(find_type("test.Items")->kind, frame);
}

TEST(Type, IsNotDefinedTwiceWithOtherTraits) {
  const Type there = {.name = "test.Traits"};
  const Type others[] = {{.name = "test.Traits", .large = true},
                         {.name = "test.Traits", .has_numbers = true},
                         {.name = "test.Traits", .has_empty = true}};
  for (const Type& other : others)
    EXPECT_THAT(told(there, other), HasSubstr("its traits are others there than here"));
}

TEST(Type, OfAManifestTakesLayoutAndCodeOfTheFirstWhoHasThem) {
  static const TypeCode code = *type_of<Plain>().code, later = code;
  const Type& type = define_type({.name = "test.Listed"});
  EXPECT_EQ(type.code, nullptr);
  define_type({.name = "test.Listed", .layout = "4/4", .code = &code});
  EXPECT_EQ(type.layout, "4/4");
  EXPECT_EQ(type.code, &code);
  define_type({.name = "test.Listed", .layout = "4/4", .code = &later});
  define_type({.name = "test.Listed"});
  EXPECT_EQ(type.layout, "4/4");
  EXPECT_EQ(type.code, &code);
}

TEST(Type, OfTwoModulesMustLieAlikeInMemory) {
  const Type& narrow = type_of<Narrow>();
  EXPECT_THAT(
      refusal([] { type_of<Wide>(); }),
      StartsWith("type 'test.Twin' is defined twice, and not alike: its layout in memory is "
                 "4/4 there and 8/8 here"));
  EXPECT_EQ(find_type("test.Twin"), &narrow);
  EXPECT_EQ(narrow.layout, "4/4");
}

TEST(TypeTraits, NeedOnlyANameAndAVersion) {
  const Type& type = type_of<Plain>();
  EXPECT_EQ(&type, find_type("test.Plain"));
  EXPECT_EQ(&type, any_value(Plain{}).type);
  EXPECT_EQ(type.version, 3);
  EXPECT_EQ(type.kind, nullptr);
  EXPECT_EQ(type.layout, "4/4");
  EXPECT_FALSE(type.large || type.has_numbers || type.has_empty);
  const Plain value{7};
  EXPECT_STREQ(type.code->fault(&value), "");
  EXPECT_EQ(type.code->bytes(&value), 4u);
  EXPECT_EQ(type.code->empty, nullptr);
  EXPECT_EQ(type.code->numbers, nullptr);
  EXPECT_EQ(type.code->range, nullptr);
  EXPECT_EQ(type.code->list, nullptr);
}

TEST(TypeTraits, MayNameAKindAndSayWhatNoStepMayGive) {
  const Type& type = type_of<toy::Segment>();
  EXPECT_EQ(type.kind, find_kind("segment"));
  EXPECT_EQ(type.kind->ranges, "FrameRange");
  EXPECT_TRUE(type.large);
  toy::Segment segment{{3, 5}, {1, 2}, {0, 1}};
  EXPECT_STREQ(type.code->fault(&segment), "");
  segment.frame[1] = 2;
  EXPECT_STREQ(type.code->fault(&segment), "a point of a frame that its segment does not have");
}

TEST(TypeTraits, MayHaveNumbersAndAnEmptyValue) {
  EXPECT_TRUE(type_of<toy::Metrics>().has_numbers);
  const toy::Metrics metrics{{{"rmse", 0.5, "m"}, {"pairs", 9, ""}}};
  EXPECT_THAT(type_of<toy::Metrics>().code->numbers(&metrics),
              ElementsAre(Field(&Number::name, "rmse"), Field(&Number::name, "pairs")));
  const Type& matches = type_of<toy::Matches>();
  EXPECT_TRUE(matches.has_empty);
  EXPECT_EQ((AnyValue{&matches, matches.code->empty()}.hash()), content_hash(toy::Matches{}));
}

TEST(TypeTraits, MaySayWhatItemsAreMadeOfAndWhatTheyJoin) {
  const toy::FrameRange range{3, 7};
  EXPECT_EQ(type_of<toy::FrameRange>().code->range(&range),
            (std::pair<std::size_t, std::size_t>(3, 7)));
  const toy::Edges edges{5, {{0, 1}, {2, 4}}};
  const ListCode* list = type_of<toy::Edges>().code->list;
  ASSERT_NE(list, nullptr);
  EXPECT_EQ(list->size(&edges), 2u);
  EXPECT_EQ(list->ends(&edges, 1), (std::pair<std::size_t, std::size_t>(2, 4)));
  EXPECT_EQ(list->ends_count(&edges), 5u);
}

TEST(TypeTraits, MayAddToMemoryAndLayout) {
  const Type& type = type_of<Indexed>();
  const Indexed value{{1, 2, 3}};
  EXPECT_EQ(type.code->bytes(&value), 8 + 3 * sizeof(float) + 300);
  EXPECT_THAT(type.layout, testing::EndsWith(", index 7"));
}

/// Through the code of its type alone, as a store does it; no part of the bytes is a value.
template <class T>
void expect_read_back(const T& value) {
  const AnyValue any = any_value(value);
  OutArchive<TextSink> out;
  any.type->code->write(any.value.get(), out);
  InArchive in(out.text);
  const AnyValue back{any.type, any.type->code->read(in)};
  EXPECT_TRUE(in.at_end()) << any.type->name;
  EXPECT_EQ(back.hash(), any.hash()) << any.type->name;
  EXPECT_EQ(to_bytes(*back.as<T>()), out.text) << any.type->name;
  for (std::size_t size = 0; size < out.text.size(); ++size) {
    InArchive cut(std::string_view(out.text).substr(0, size));
    EXPECT_THROW(any.type->code->read(cut), Error) << any.type->name << ", " << size;
  }
}

TEST(AnyValue, IsReadBackAsItWasWritten) {
  expect_read_back(Plain{-7});
  expect_read_back(toy::Frame{7, 0.5f});
  expect_read_back(toy::Segment{{3, 5}, {1, 2, 2.5f}, {0, 1, 1}});
  expect_read_back(toy::Edges{3, {{0, 1}, {1, 2}}});
  expect_read_back(toy::Metrics{{{"rmse", 0.21, "m"}}});
}

TEST(AnyValue, HasTheHashOfItsContent) {
  const toy::Segment segment{{3, 5}, {1, 2}, {0, 1}};
  const Hash128 hash = any_value(segment).hash();
  EXPECT_EQ(any_value(toy::Segment(segment)).hash(), hash);
  EXPECT_EQ(hash, content_hash(segment));
  const toy::Segment others[] = {{{2, 5}, {1, 2}, {0, 1}},
                                 {{3, 6}, {1, 2}, {0, 1}},
                                 {{3, 5}, {1, 2.5f}, {0, 1}},
                                 {{3, 5}, {1, 2}, {0, 0}},
                                 {{3, 5}, {1}, {2, 0, 1}}};
  for (const toy::Segment& other : others) EXPECT_NE(any_value(other).hash(), hash);
}

TEST(Type, IsDefinedTogetherWithItsKind) {
  const std::vector<ItemKind> kinds = {{.name = "test.bay", .parts = "frame"}};
  const std::vector<TypeDraft> types = {{{.name = "test.Bay", .layout = "8/8"}, "test.bay"},
                                        {{.name = "test.Bays"}, {}}};
  define_together(kinds, types);
  ASSERT_NE(find_kind("test.bay"), nullptr);
  EXPECT_EQ(find_type("test.Bay")->kind, find_kind("test.bay"));
  EXPECT_EQ(find_type("test.Bays")->kind, nullptr);
  const Type* first = find_type("test.Bay");
  define_together(kinds, types);
  EXPECT_EQ(find_type("test.Bay"), first);
}

TEST(Type, IsNotDefinedWhereOneBesideItContradicts) {
  define_type({.name = "test.Old"});
  EXPECT_THAT(refusal([] {
                define_together({{.name = "test.stray"}}, {{{.name = "test.Stray"}, "test.stray"},
                                                           {{.name = "test.Old"}, "test.stray"}});
              }),
              HasSubstr("one for the whole pipeline there and one per test.stray here"));
  EXPECT_THAT(refusal([] {
                define_together({}, {{{.name = "test.Stray"}, "test.stray"}});
              }),
              HasSubstr("item kind 'test.stray' is named and not defined"));
  EXPECT_EQ(find_kind("test.stray"), nullptr);
  EXPECT_EQ(find_type("test.Stray"), nullptr);
}

}  // namespace
}  // namespace plumb
