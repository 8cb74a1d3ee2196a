# cpack: Debian packages, one for each of these parts of what the build installs (docs/start/install.md).
set(brume_packages program brume sim_library libbrume-sim0 library libbrume0 development libbrume-dev
                   blender brume-blender documentation brume-doc)
if(BRUME_PYTHON_BUILT)
  list(APPEND brume_packages python python3-brume)
endif()
set(brume_package_files ${CMAKE_CURRENT_LIST_DIR}/package)

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_PACKAGE_CONTACT "The Brume authors <maintainers@brume.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${brume_package_files}/compress_manual.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SOURCE brume)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(exact "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")

# brume_package(COMPONENT SECTION SUMMARY TEXT): the lines of a package's control file that all have.
function(brume_package component section summary text)
  string(TOUPPER ${component} key)
  list(FIND brume_packages ${component} at)
  math(EXPR at "${at} + 1")
  list(GET brume_packages ${at} name)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  set(of_part COMPONENT ${component})
  if(NOT component STREQUAL program)
    list(APPEND of_part EXCLUDE_FROM_ALL)
  endif()
  foreach(file IN ITEMS copyright changelog.gz changelog.Debian.gz)
    install(FILES ${PROJECT_BINARY_DIR}/package/${file} DESTINATION share/doc/${name} ${of_part})
  endforeach()
endfunction()

set(CPACK_COMPONENTS_ALL)
string(CONCAT about "Brume floods rooms with smoke that walls stop, doors let through and\n"
                    "shots punch holes into, the same on every machine, and renders it with\nVulkan.")
brume_package(program graphics "real-time volumetric smoke, clouds and sparse volumes"
  "${about}\nThis package holds the program with its viewer, and scenes.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libembree3-3, libvulkan1, fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "ffmpeg, mesa-vulkan-drivers | vulkan-icd")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "brume-doc, brume-blender, python3-brume")

brume_package(sim_library libs "simulation of volumetric smoke (library)"
  "${about}\nThis package holds the library of the simulation, without graphics.")
brume_package(library libs "volumetric smoke in the frames of a Vulkan renderer (library)"
  "${about}\nThis package holds the library that draws smoke into the frames of other\nrenderers.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS libembree3-3)
foreach(pair IN ITEMS "SIM_LIBRARY brume-sim" "LIBRARY brume")
  string(REPLACE " " ";" pair ${pair})
  list(GET pair 0 key)
  list(GET pair 1 library)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/package/${key}/shlibs
       CONTENT "lib${library} 0 lib${library}0 (>= ${PROJECT_VERSION})\n")
  set(CPACK_DEBIAN_${key}_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/package/${key}/shlibs
                                                ${brume_package_files}/library/triggers)
endforeach()

brume_package(development libdevel "volumetric smoke in games and servers (development files)"
  "${about}\nThis package holds the headers of both libraries, what CMake and\npkg-config find them by, and examples.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libbrume0 ${exact}, libbrume-sim0 ${exact}, libvulkan-dev")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/hello_host ${PROJECT_SOURCE_DIR}/examples/host
        ${PROJECT_SOURCE_DIR}/examples/server
        DESTINATION share/doc/libbrume-dev/examples COMPONENT development EXCLUDE_FROM_ALL)

if(BRUME_PYTHON_BUILT)
  math(EXPR next_minor "${BRUME_PYTHON_MINOR} + 1")
  brume_package(python python "volumetric smoke as NumPy arrays"
    "${about}\nThis package holds the Python module brume.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= 3.${BRUME_PYTHON_MINOR}), python3 (<< 3.${next_minor}), python3-numpy, libembree3-3, libvulkan1, \
fonts-dejavu-core")
  # brume-vdb, which reads and writes the files of OpenVDB; and something to draw with.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "brume ${exact}, mesa-vulkan-drivers | vulkan-icd")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${brume_package_files}/python/postinst
                                                ${brume_package_files}/python/prerm)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/python DESTINATION share/doc/python3-brume/examples COMPONENT python
          EXCLUDE_FROM_ALL PATTERN __pycache__ EXCLUDE)
endif()

brume_package(blender graphics "volumetric smoke in Blender (add-on)"
  "${about}\nThis package holds the add-on for Blender, which exports levels and\nrenders their smoke.")
set(CPACK_DEBIAN_BLENDER_PACKAGE_DEPENDS "blender, brume ${exact}")
set(CPACK_DEBIAN_BLENDER_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_BLENDER_PACKAGE_CONTROL_EXTRA ${brume_package_files}/blender/prerm)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/integrations/blender/brume_blender/
        DESTINATION share/blender/scripts/addons/brume_blender COMPONENT blender EXCLUDE_FROM_ALL
        FILES_MATCHING PATTERN "*.py" PATTERN "*.toml" PATTERN __pycache__ EXCLUDE)

brume_package(documentation doc "volumetric smoke, clouds and sparse volumes (documentation)"
  "${about}\nThis package holds the pages about its use and its methods.")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION share/doc/brume-doc COMPONENT documentation EXCLUDE_FROM_ALL)
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION share/doc/brume-doc COMPONENT documentation EXCLUDE_FROM_ALL)

# The licences and the changelogs, which every package holds. The date of the version is that of CHANGELOG.md.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
file(STRINGS ${PROJECT_SOURCE_DIR}/CHANGELOG.md date REGEX "^## ${PROJECT_VERSION} - [-0-9]+$")
if(NOT date)
  message(FATAL_ERROR "CHANGELOG.md: expected '## ${PROJECT_VERSION} - YYYY-MM-DD', the version of CMakeLists.txt")
endif()
string(REGEX REPLACE ".* - " "" date "${date}")
execute_process(COMMAND date --utc --rfc-email --date=${date} OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE licence)
file(READ ${PROJECT_SOURCE_DIR}/NOTICES.txt notices)
file(READ ${PROJECT_SOURCE_DIR}/data/palettes/LICENSES.txt licences)
# The text of the Apache license comes last; Debian has it.
string(FIND "${licences}" "\nApache License\n" at)
if(at LESS 0)
  message(FATAL_ERROR "data/palettes/LICENSES.txt: expected the text of the Apache License at its end")
endif()
string(SUBSTRING "${licences}" 0 ${at} licences)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/package/copyright @ONLY CONTENT
"Brume
=====

@licence@

@notices@

@licences@
The text of the Apache License 2.0 is in /usr/share/common-licenses/Apache-2.0.
")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/package/changelog.Debian @ONLY CONTENT
"brume (@PROJECT_VERSION@-@CPACK_DEBIAN_PACKAGE_RELEASE@) bookworm; urgency=medium

  * Version @PROJECT_VERSION@: see changelog.gz.

 -- @CPACK_PACKAGE_CONTACT@  @date@
")
configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_BINARY_DIR}/package/changelog COPYONLY)
foreach(file IN ITEMS changelog changelog.Debian)
  execute_process(COMMAND gzip -9nkf ${PROJECT_BINARY_DIR}/package/${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

include(CPack)
