#include "plumb/plugin/build_identity.hpp"

#include <elf.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <vector>

#include "plumb/data/error.hpp"
#include "plumb/data/hash.hpp"
#include "plumb/plugin/trusted_file.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t largest_notes = std::size_t{1} << 20;

/// Bytes [at, at + size) of a file; fewer where it ends.
std::string bytes_at(std::ifstream& file, std::uint64_t at, std::size_t size) {
  std::string bytes(size, '\0');
  file.clear();
  file.seekg(static_cast<std::streamoff>(at));
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return bytes;
}

template <class T>
bool take(const std::string& bytes, std::size_t at, T& value) {
  if (at > bytes.size() || sizeof value > bytes.size() - at) return false;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return true;
}

std::string hexadecimal(std::string_view bytes) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

/// The build ID among the notes of a segment; "" when it is not there.
std::string build_id_in(const std::string& notes) {
  const auto padded = [](std::size_t n) { return (n + 3) & ~std::size_t{3}; };
  Elf64_Nhdr note{};
  for (std::size_t at = 0; take(notes, at, note);) {
    const std::size_t name = at + sizeof note, text = name + padded(note.n_namesz);
    if (text > notes.size() || note.n_descsz > notes.size() - text) return "";
    const std::string_view owner(notes.data() + name, std::min<std::size_t>(note.n_namesz, 4));
    if (note.n_type == NT_GNU_BUILD_ID && owner == std::string_view("GNU\0", 4))
      return hexadecimal({notes.data() + text, note.n_descsz});
    at = text + padded(note.n_descsz);
  }
  return "";
}

/// Of an ELF file for 64 bits; "" for any other.
std::string build_id_of(std::ifstream& file) {
  Elf64_Ehdr header{};
  const std::string head = bytes_at(file, 0, sizeof header);
  if (!take(head, 0, header) || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 ||
      header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_phentsize != sizeof(Elf64_Phdr))
    return "";
  const std::string segments =
      bytes_at(file, header.e_phoff, std::size_t{header.e_phnum} * sizeof(Elf64_Phdr));
  Elf64_Phdr segment{};
  for (std::size_t k = 0; take(segments, k * sizeof segment, segment); ++k) {
    if (segment.p_type != PT_NOTE || segment.p_filesz > largest_notes) continue;
    const std::string found = build_id_in(bytes_at(file, segment.p_offset, segment.p_filesz));
    if (!found.empty()) return found;
  }
  return "";
}

}  // namespace

std::string build_of(const fs::path& library) {
  std::ifstream file(library, std::ios::binary);
  if (!file) throw Error(library.string() + ": cannot be read");
  if (std::string id = build_id_of(file); !id.empty()) return id;
  Hasher hasher;
  for (std::uint64_t at = 0;;) {
    const std::string piece = bytes_at(file, at, std::size_t{1} << 20);
    if (piece.empty()) return hasher.hash().text();
    hasher.bytes(piece.data(), piece.size());
    at += piece.size();
  }
}

const std::string& build_of_libraries() {
  static const std::string build = [] {
    std::vector<fs::path> libraries;
    std::error_code error;
    for (fs::directory_iterator entry(folder_of_this_library(), error), end; !error && entry != end;
         entry.increment(error)) {
      const std::string name = entry->path().filename().string();
      const std::string version = entry->path().extension().string();  // ".0": what modules load
      if (name.starts_with("libplumb_") && name.ends_with(".so" + version) && version.size() > 1 &&
          version.find_first_not_of("0123456789", 1) == std::string::npos)
        libraries.push_back(*entry);
    }
    std::sort(libraries.begin(), libraries.end());
    Hasher hasher;
    for (const fs::path& library : libraries) hasher.text(build_of(library));
    return hasher.hash().text();
  }();
  return build;
}

}  // namespace plumb
