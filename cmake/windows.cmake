# Toolchain: compiles for Windows (x86-64) on Debian, by MinGW-w64 with POSIX threads. script/windows-libraries makes the
# libraries that it links.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(mingw x86_64-w64-mingw32)
set(CMAKE_C_COMPILER ${mingw}-gcc-posix)
set(CMAKE_CXX_COMPILER ${mingw}-g++-posix)
set(CMAKE_RC_COMPILER ${mingw}-windres)

# Programs of this machine; libraries, headers and packages of the other one.
get_filename_component(BRUME_WINDOWS_LIBRARIES ${CMAKE_CURRENT_LIST_DIR}/../build/windows-libraries/prefix ABSOLUTE)
set(CMAKE_FIND_ROOT_PATH ${BRUME_WINDOWS_LIBRARIES} /usr/${mingw})
set(CMAKE_PREFIX_PATH /)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_LIBDIR} ${BRUME_WINDOWS_LIBRARIES}/lib/pkgconfig)
set(PKG_CONFIG_ARGN --static)
foreach(language IN ITEMS C CXX)
  set(CMAKE_${language}_STANDARD_INCLUDE_DIRECTORIES ${BRUME_WINDOWS_LIBRARIES}/include)
endforeach()

# Programs and libraries bring the runtimes of the compiler with them.
foreach(kind IN ITEMS EXE SHARED MODULE)
  set(CMAKE_${kind}_LINKER_FLAGS_INIT "-static -L${BRUME_WINDOWS_LIBRARIES}/lib")
endforeach()
