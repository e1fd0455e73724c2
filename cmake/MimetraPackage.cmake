# What makes an installation a CMake package, and the documents beside it. Included after all
# libraries.

include(CMakePackageConfigHelpers)

get_property(components GLOBAL PROPERTY MIMETRA_COMPONENTS)
set(component_table "")
set(packages "")
foreach(component IN LISTS components)
  get_property(uses GLOBAL PROPERTY MIMETRA_${component}_USES)
  get_property(needed GLOBAL PROPERTY MIMETRA_${component}_PACKAGES)
  list(APPEND packages ${needed})
  string(APPEND component_table "set(mimetra_${component}_uses ${uses})\n"
         "set(mimetra_${component}_packages ${needed})\n")
endforeach()
list(REMOVE_DUPLICATES packages)
list(JOIN components " " components)
foreach(package IN LISTS packages)
  if(NOT DEFINED MIMETRA_FIND_${package})
    message(FATAL_ERROR "PACKAGES ${package}: find it by mimetra_package()")
  endif()
  string(APPEND component_table "set(mimetra_find_${package} ${MIMETRA_FIND_${package}})\n")
endforeach()
string(REPLACE ";" " " component_table "${component_table}")

configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/mimetraConfig.cmake.in ${PROJECT_BINARY_DIR}/mimetraConfig.cmake
  INSTALL_DESTINATION ${MIMETRA_PACKAGE_FOLDER}
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mimetraConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/mimetraConfig.cmake
              ${PROJECT_BINARY_DIR}/mimetraConfigVersion.cmake
        DESTINATION ${MIMETRA_PACKAGE_FOLDER})

install(FILES all.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mimetra)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN site EXCLUDE)
