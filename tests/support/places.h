// Where the tests find the project and what was built. Included before everything else, so that no file but places.cpp
// depends on where that is.
#pragma once

namespace relook::places {

extern const char* const kSourceFolder;
extern const char* const kProgram;
extern const char* const kFaultShim;
extern const char* const kHostileShim;

}  // namespace relook::places

#define RELOOK_SOURCE_DIR ::relook::places::kSourceFolder
#define RELOOK_PROGRAM ::relook::places::kProgram
#define RELOOK_FAULT_SHIM ::relook::places::kFaultShim
#define RELOOK_HOSTILE_SHIM ::relook::places::kHostileShim
