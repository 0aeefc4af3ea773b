// Which sanitizers this is compiled with: gcc defines a name for each, clang says it as a feature.
#pragma once

namespace relook {

#if defined(__has_feature)
inline constexpr bool kHasAddressSanitizer = __has_feature(address_sanitizer);
inline constexpr bool kHasThreadSanitizer = __has_feature(thread_sanitizer);
#else
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kHasAddressSanitizer = true;
#else
inline constexpr bool kHasAddressSanitizer = false;
#endif
#if defined(__SANITIZE_THREAD__)
inline constexpr bool kHasThreadSanitizer = true;
#else
inline constexpr bool kHasThreadSanitizer = false;
#endif
#endif

/// Whether a sanitizer makes the process take other amounts of memory and time than it does without.
inline constexpr bool kIsInstrumented = kHasAddressSanitizer || kHasThreadSanitizer;

}  // namespace relook
