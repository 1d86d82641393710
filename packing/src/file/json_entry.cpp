#include "file/json_entry.hpp"

#include "innersphere/error.hpp"

namespace innersphere {
namespace {

using nlohmann::json;

// Says what is wrong, and ends a parse that goes deeper than any packing does: the CBOR parser recurses, and
// a few megabytes of opening brackets would use up the stack.
class Judge : public nlohmann::json_sax<json> {
 public:
  explicit Judge(std::size_t size) : size_(size) {}
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool key(string_t&) override { return true; }
  bool start_object(std::size_t) override { return ++depth_ <= kDeepest; }
  bool start_array(std::size_t) override { return ++depth_ <= kDeepest; }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t byte, const std::string&, const nlohmann::detail::exception& error) override {
    if (byte > size_) damaged("it ends early, after " + std::to_string(size_) + " bytes");
    damaged(error);
  }

 private:
  static constexpr int kDeepest = 16;
  bool leave() {
    --depth_;
    return true;
  }
  const std::size_t size_;  // [bytes]
  int depth_ = 0;
};

}  // namespace

void damaged(const std::string& what) {
  throw Error(ErrorCode::bad_format, what + "; the file is damaged");
}

void damaged(const json::exception& error) {
  const std::string what = error.what();
  damaged(what.substr(what.find(' ') + 1));  // after "[json.exception...]"
}

json parseJson(const std::string& bytes, json::input_format_t format) {
  Judge judge(bytes.size());
  if (!json::sax_parse(bytes, &judge, format)) damaged("entries are nested too deeply");
  return format == json::input_format_t::cbor ? json::from_cbor(bytes) : json::parse(bytes);
}

MassProperties massPropertiesOf(const JsonEntry& entry) {
  return {entry["volume"].number(), entry["centre_of_mass"].vector(), entry["inertia"].numbers<9>()};
}

Provenance provenanceOf(const JsonEntry& entry) {
  return {entry["source"].text(), entry["source_hash"].text(), entry["options"].text(),
          entry["innersphere_version"].text()};
}

}  // namespace innersphere
