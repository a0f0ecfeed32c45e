#pragma once
/// Whose files a store takes.

namespace plumb {

/// Whosever they are, they must be regular files, which links are not.
enum class Whose {
  own,      ///< of this user or root, and nobody else may write them
  anyones,  ///< whoever may write there is trusted
};

}  // namespace plumb
