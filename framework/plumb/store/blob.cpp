#include "plumb/store/blob.hpp"

#include <array>

#include "plumb/data/archive.hpp"

namespace plumb {
namespace {

constexpr std::string_view magic = "plumb blob 2\n";
constexpr std::size_t sum_size = 2 * sizeof(std::uint64_t);

/// Another program may know it.
class UnknownType : public Error {
 public:
  using Error::Error;
};

/// Places are counted from the first byte of the file: arrays are aligned there.
std::optional<BlobHead> take_head(const Hash128& key, InArchive& in) {
  std::array<char, magic.size()> seen;
  for (char& c : seen) in(c);
  if (std::string_view(seen.data(), seen.size()) != magic) return std::nullopt;
  BlobHead head;
  in(head.key.high, head.key.low, head.step);
  if (head.key != key) return std::nullopt;
  return head;
}

/// One value, such as a step may give it.
AnyValue take_any(InArchive& in) {
  std::string name;
  int version = 0;
  in(name, version);
  const Type* type = find_type(name);
  if (!type || !type->code || type->version != version)
    throw UnknownType("holds values of a type that this program does not know");
  AnyValue value{type, type->code->read(in)};
  if (const char* fault = type->code->fault(value.value.get()); *fault)
    throw Error(std::string("holds ") + fault);
  return value;
}

StoredResult take_result(InArchive& in) {
  StoredResult result;
  std::uint64_t outputs = 0, count = 0;
  in(outputs);
  for (std::uint64_t o = 0; o < outputs; ++o) {
    std::uint64_t values = 0;
    in(values);
    auto& to = result.outputs.emplace_back();
    for (std::uint64_t v = 0; v < values; ++v) to.push_back(take_any(in));
  }
  in(count);
  for (std::uint64_t n = 0; n < count; ++n) {
    auto& [what, number] = result.counts.emplace_back();
    in(what, number);
  }
  in(result.warnings);
  if (!in.at_end()) throw Error("has bytes left over");
  return result;
}

/// All but the checksum; empty when that does not fit.
std::string_view body_of(std::string_view bytes) {
  if (bytes.size() < magic.size() + sum_size || !bytes.starts_with(magic)) return {};
  const std::string_view body = bytes.substr(0, bytes.size() - sum_size);
  Hash128 sum;
  InArchive(bytes.substr(body.size()))(sum.high, sum.low);
  return sum == hash_of(body) ? body : std::string_view();
}

void write_body(const Hash128& key, const StoredResult& result, std::string_view step,
                OutArchive<TextSink>& out) {
  out.put(magic.data(), magic.size());
  out(key.high, key.low, std::string(step), static_cast<std::uint64_t>(result.outputs.size()));
  for (const auto& values : result.outputs) {
    out(static_cast<std::uint64_t>(values.size()));
    for (const AnyValue& value : values) {
      out(value.type->name, value.type->version);
      value.type->code->write(value.value.get(), out);
    }
  }
  out(static_cast<std::uint64_t>(result.counts.size()));
  for (const auto& [what, n] : result.counts) out(what, n);
  out(result.warnings);
}

}  // namespace

std::size_t size_of_blob(const StoredResult& result) {
  std::size_t size = 1024;
  for (const auto& values : result.outputs)
    for (const AnyValue& value : values)
      size += value.type->code->bytes(value.value.get()) + 32 * array_alignment;
  return size;
}

std::string blob_of(const Hash128& key, const StoredResult& result, std::string_view step) {
  OutArchive<TextSink> out;
  out.text.reserve(size_of_blob(result));  // one buffer, never moved
  write_body(key, result, step, out);
  const Hash128 sum = hash_of(out.text);
  out(sum.high, sum.low);
  return std::move(out.text);
}

void give_blob(const Hash128& key, const StoredResult& result, std::string_view step,
               const std::function<void(std::string_view)>& take) {
  Hasher hasher;
  OutArchive<TextSink> out;
  out.take = [&](std::string_view bytes) {
    hasher.bytes(bytes.data(), bytes.size());
    take(bytes);
  };
  write_body(key, result, step, out);
  out.flush();
  const Hash128 sum = hasher.hash();
  OutArchive<TextSink> end;
  end(sum.high, sum.low);
  take(end.text);
}

std::optional<StoredResult> read_blob(const Hash128& key, std::string_view bytes,
                                      std::string* why) {
  try {
    const std::string_view body = body_of(bytes);
    InArchive in(body);
    if (body.empty() || !take_head(key, in)) throw Error("was cut or altered");
    return take_result(in);
  } catch (const Error& e) {
    if (why) *why = e.what();
    return std::nullopt;
  }
}

std::optional<BlobHead> check_blob(const Hash128& key, std::string_view bytes) {
  try {
    const std::string_view body = body_of(bytes);
    InArchive in(body);
    auto head = body.empty() ? std::nullopt : take_head(key, in);
    if (head) try {
        take_result(in);
      } catch (const UnknownType&) {
      }
    return head;
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::optional<BlobHead> read_head(const Hash128& key, std::string_view beginning) {
  try {
    InArchive in(beginning);
    return take_head(key, in);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace plumb
