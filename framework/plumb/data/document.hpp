#pragma once
/// The one value that the engine itself looks into: a file in the making.

#include <string>

#include "plumb/data/file_bytes.hpp"
#include "plumb/data/type.hpp"

namespace plumb {

/// The engine puts it into the output folder.
struct Document {
  std::string name;  ///< file name, without a folder
  FileBytes bytes;
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Document>
void fields(Archive& a, T& d) { a(d.name, d.bytes); }

template <>
struct TypeTraits<Document> {
  static constexpr const char* name = "Document";
  static constexpr int version = 1;
};

}  // namespace plumb
