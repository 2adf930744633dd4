// The library's version; CMakeLists.txt reads it from here.
#pragma once

#define LODESTONE_VERSION_MAJOR 0
#define LODESTONE_VERSION_MINOR 1
#define LODESTONE_VERSION_PATCH 0
#define LODESTONE_VERSION_STRING "0.1.0"
