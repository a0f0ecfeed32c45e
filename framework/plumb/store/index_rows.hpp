#pragma once
/// What the rows of the index hold beside numbers and text: lists, in an archive's bytes.

#include <chrono>
#include <string>
#include <type_traits>

#include "plumb/data/archive.hpp"
#include "plumb/store/database.hpp"
#include "plumb/store/index.hpp"

namespace plumb {

inline std::int64_t now_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

[[noreturn]] inline void refuse_row(const char* table) {
  throw DatabaseError(DatabaseError::Cause::damage,
                      std::string("a row of its table '") + table + "' is not as it was written");
}

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Fact>
void fields(Archive& a, T& fact) { a(fact.name, fact.value); }

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, CountOf>
void fields(Archive& a, T& count) { a(count.what, count.n); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Recalled>
void fields(Archive& a, T& r) {
  a(r.items, r.whole, r.values, r.numbers, r.counts, r.warnings, r.facts);
}

}  // namespace plumb
