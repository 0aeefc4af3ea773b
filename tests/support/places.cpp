#include "places.h"

namespace relook::places {

const char* const kSourceFolder = RELOOK_PLACE_OF_SOURCES;
const char* const kProgram = RELOOK_PLACE_OF_PROGRAM;
const char* const kFaultShim = RELOOK_PLACE_OF_FAULT_SHIM;
const char* const kHostileShim = RELOOK_PLACE_OF_HOSTILE_SHIM;

}  // namespace relook::places
