# What the packages say of themselves.
set(maintainer "mimetra developers <mimetra@localhost>")
set(packages libmimetra-c1 libmimetra-pictures1 mimetra libmimetra-dev python3-mimetra
    mimetra-blender mimetra-paraview)

# The viewer of reports is bundled from packages of npm; their licences stand at its beginning.
set(viewer_licenses " None: reports of this build have no viewer.")
if(EXISTS "${VIEWER}")
  file(READ "${VIEWER}" script LIMIT 200000)
  string(FIND "${script}" "/*!\n" begin)
  string(FIND "${script}" "*/" end)
  if(NOT begin EQUAL -1)
    math(EXPR begin "${begin} + 4")
    math(EXPR length "${end} - ${begin}")
    string(SUBSTRING "${script}" ${begin} ${length} licenses)
    # A compiler's literals are short, and a paragraph of a copyright file goes on after a dot.
    string(REPLACE ")viewer\"\nR\"viewer(" "" licenses "${licenses}")
    string(STRIP "${licenses}" licenses)
    string(REGEX REPLACE "\r|[ \t]+\n" "\n" licenses " ${licenses}")
    string(REGEX REPLACE "\n+" "\n \n " licenses "${licenses}")
    string(REPLACE "\n \n" "\n .\n" viewer_licenses "${licenses}")
  endif()
endif()
configure_file(../copyright.in copyright @ONLY)
configure_file(changelog.in changelog @ONLY)
execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/changelog COMMAND_ERROR_IS_FATAL ANY)
foreach(name c pictures)
  set(folder ${PROJECT_BINARY_DIR}/libmimetra-${name}1)
  file(WRITE ${folder}/shlibs "libmimetra_${name} 1 libmimetra-${name}1 (>= ${PROJECT_VERSION})\n")
  file(WRITE ${folder}/triggers "activate-noawait ldconfig\n")
endforeach()
file(APPEND ${PROJECT_BINARY_DIR}/libmimetra-pictures1/shlibs
     "libmimetra_painter 1 libmimetra-pictures1 (>= ${PROJECT_VERSION})\n")

set(about "mimetra finds the regions of an animated face that move, and transfers their
deformation to another character: sparse localized deformation components,
deformation gradients, a bounded solve for the weights of expressions.")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mimetra)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT ${maintainer})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR})
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
                                                GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL ${packages})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SOURCE mimetra)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_STRIP_FILES ON)
# Without one, CPack would name that of CMake.
unset(CPACK_DEBIAN_PACKAGE_HOMEPAGE)

# package(NAME SECTION section SUMMARY line TEXT text [ALL] [SHLIBDEPS] [DEPENDS ...]
#   [RECOMMENDS ...] [SUGGESTS ...] [OVERRIDES lines for lintian])
macro(package name)
  cmake_parse_arguments(ARG "ALL;SHLIBDEPS" "SECTION;SUMMARY;TEXT" "DEPENDS;RECOMMENDS;SUGGESTS;OVERRIDES"
                        ${ARGN})
  string(TOUPPER ${name} NAME)
  set(prefix CPACK_DEBIAN_${NAME}_PACKAGE)
  set(${prefix}_NAME ${name})
  set(${prefix}_SECTION ${ARG_SECTION})
  set(CPACK_COMPONENT_${NAME}_DESCRIPTION "${ARG_SUMMARY}\n${about}\n\n${ARG_TEXT}")
  foreach(relation DEPENDS RECOMMENDS SUGGESTS)
    list(JOIN ARG_${relation} ", " ${prefix}_${relation})
  endforeach()
  set(${prefix}_SHLIBDEPS OFF)
  if(ARG_SHLIBDEPS)
    set(${prefix}_SHLIBDEPS ON)
  endif()
  if(ARG_ALL)
    set(${prefix}_ARCHITECTURE all)
  endif()
  # Scripts, and what the loader and other packages must know.
  file(GLOB ${prefix}_CONTROL_EXTRA ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*
       ${PROJECT_BINARY_DIR}/${name}/*)

  set(documents share/doc/${name})
  install(FILES ${PROJECT_BINARY_DIR}/copyright ${PROJECT_BINARY_DIR}/changelog.gz
          DESTINATION ${documents} COMPONENT ${name})
  file(WRITE ${PROJECT_BINARY_DIR}/overrides/${name}
       "# The project has no mail address.\n${name}: bogus-mail-host\n"
       "${name}: bogus-mail-host-in-debian-changelog\n" ${ARG_OVERRIDES})
  install(FILES ${PROJECT_BINARY_DIR}/overrides/${name} DESTINATION share/lintian/overrides
          COMPONENT ${name})
endmacro()
set(same "(= ${PROJECT_VERSION})")
set(video libavformat59 libavcodec59 libswscale6 libavutil57)

package(libmimetra-c1 SECTION libs SHLIBDEPS
  SUMMARY "region-based deformation transfer (C library)"
  TEXT "This package holds the library of the C interface, by which programs run every
operation on arrays of their own. It has a build for processors with AVX2 and
FMA, which the loader chooses."
  RECOMMENDS ${video} libdlib-data
  OVERRIDES "# CPack writes these scripts itself.\n" "libmimetra-c1: maintscript-calls-ldconfig\n")
package(libmimetra-pictures1 SECTION libs SHLIBDEPS
  SUMMARY "region-based deformation transfer (library that draws)"
  TEXT "This package holds the library of the C interface with pictures, pages for a
browser and ParaView's files, for which it needs VTK, and the library that
draws, which the command loads, too. The Python module takes it where it is
installed."
  RECOMMENDS ${video} libdlib-data
  OVERRIDES "# CPack writes these scripts itself.\n"
            "libmimetra-pictures1: maintscript-calls-ldconfig\n"
            "# The library that draws is of no use to others.\n"
            "libmimetra-pictures1: package-name-doesnt-match-sonames libmimetra-painter1*\n")
package(mimetra SECTION graphics SHLIBDEPS
  SUMMARY "region-based deformation transfer (command)"
  TEXT "This package holds the command, its manual and completion. It has a build for
processors with AVX2 and FMA, which it chooses when it starts. Videos need the
libraries of FFmpeg, faces in pictures the data of dlib."
  DEPENDS "libmimetra-pictures1 ${same}"
  RECOMMENDS ${video} libdlib-data
  SUGGESTS paraview mimetra-paraview mimetra-blender python3-mimetra)
package(libmimetra-dev SECTION libdevel
  SUMMARY "region-based deformation transfer (development files)"
  TEXT "This package holds the headers, the static libraries of all parts, and what
CMake and pkg-config ask for. The component vtk needs ParaView's development
files, what draws libmimetra-pictures1."
  DEPENDS "libmimetra-c1 ${same}" libeigen3-dev libopenmesh-dev libcgal-dev nlohmann-json3-dev
          libzip-dev zipcmp zipmerge ziptool zlib1g-dev libpng-dev libjpeg-dev
          libmeshoptimizer-dev libdraco-dev
  SUGGESTS paraview-dev libmimetra-pictures1 libdlib-dev cmake pkg-config)
package(python3-mimetra SECTION python ALL
  SUMMARY "region-based deformation transfer (Python module)"
  TEXT "This package holds the Python module: each operation is a function on NumPy
arrays."
  DEPENDS "libmimetra-c1 (>= ${PROJECT_VERSION})" "python3 (>= 3.9)" python3-numpy
  RECOMMENDS libmimetra-pictures1)
package(mimetra-blender SECTION graphics ALL
  SUMMARY "region-based deformation transfer (Blender add-on)"
  TEXT "This package holds the add-on for Blender: switch Animation: mimetra on in
Edit > Preferences > Add-ons."
  DEPENDS "python3-mimetra ${same}" "blender (>= 3.4)")
package(mimetra-paraview SECTION science SHLIBDEPS
  SUMMARY "region-based deformation transfer (ParaView plugin)"
  TEXT "This package holds the plugin for ParaView with readers and filters. Choose
/usr/${libraries}/${paraview}/Mimetra/Mimetra.so
in Tools > Manage Plugins > Load New, or start ParaView with its folder in
PV_PLUGIN_PATH."
  DEPENDS "paraview"
  RECOMMENDS python3-paraview)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/paraview/BASELINE)
include(CPack)
