#include "plumb/data/document.hpp"

namespace plumb {
namespace {

/// Registered when the library is loaded, so that stored documents can be read whatever module is
/// there.
const bool defined = (type_of<Document>(), true);

}  // namespace
}  // namespace plumb
