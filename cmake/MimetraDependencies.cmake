# mimetra_package(NAME ARGUMENTS ...): finds a package, and notes how, for users of the libraries.
macro(mimetra_package name)
  find_package(${name} ${ARGN} REQUIRED)
  set(MIMETRA_FIND_${name} ${name} ${ARGN})
endmacro()

mimetra_package(Threads)
mimetra_package(Eigen3 3.4 NO_MODULE)
# Not the module of this name that CGAL brings, which knows no targets.
mimetra_package(OpenMesh CONFIG)
mimetra_package(CGAL)
mimetra_package(nlohmann_json)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
mimetra_package(HDF5 COMPONENTS C)
include(MimetraDlib)

# VTK 9.1 or later: ParaView's own where it is installed, because that one serves the toolkit, the
# plugin and the tests alike; otherwise the system's.
file(GLOB paraview_vtk /usr/lib/*/cmake/paraview-*/vtk)
if(NOT VTK_DIR AND paraview_vtk)
  list(GET paraview_vtk -1 VTK_DIR)
endif()
mimetra_package(GLEW)
mimetra_package(OpenGL COMPONENTS EGL)
set(vtk_components ChartsCore CommonCore CommonDataModel IOCore IOImage IOXML IOXMLParser RenderingContext2D
                   RenderingContextOpenGL2 RenderingCore RenderingFreeType RenderingOpenGL2)
find_package(VTK 9.1 REQUIRED COMPONENTS ${vtk_components})
# Objects compiled against one VTK break with another one's libraries.
set(MIMETRA_FIND_VTK VTK ${VTK_VERSION} EXACT COMPONENTS ${vtk_components} HINTS ${VTK_DIR})

if(BUILD_TESTING)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
