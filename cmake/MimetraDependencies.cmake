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
if(MIMETRA_FILES)
  mimetra_package(nlohmann_json)
  mimetra_package(libzip)
  mimetra_package(ZLIB)
endif()
if(MIMETRA_FITTING)
  include(MimetraDlib)
endif()
if(MIMETRA_COMMAND)
  find_package(fmt REQUIRED)
  find_package(spdlog REQUIRED)
  find_package(CLI11 REQUIRED)
endif()

if(MIMETRA_VTK)
  # VTK 9.1 or later: ParaView's own where it is installed, because that one serves the toolkit, the
  # plugin and the tests alike; otherwise the system's.
  file(GLOB paraview_vtk /usr/lib/*/cmake/paraview-*/vtk)
  if(NOT VTK_DIR AND paraview_vtk)
    list(GET paraview_vtk -1 VTK_DIR)
  endif()
  mimetra_package(GLEW)
  mimetra_package(OpenGL COMPONENTS EGL)
  set(vtk_files CommonCore CommonDataModel IOCore IOXML IOXMLParser)
  set(vtk_rendering ChartsCore IOImage RenderingContext2D RenderingContextOpenGL2 RenderingCore
                    RenderingFreeType RenderingOpenGL2)
  find_package(VTK 9.1 REQUIRED COMPONENTS ${vtk_files} ${vtk_rendering})
  # Objects compiled against one VTK break with another one's libraries.
  set(same_vtk VTK ${VTK_VERSION} EXACT HINTS ${VTK_DIR})
  set(MIMETRA_FIND_VTK ${same_vtk} COMPONENTS ${vtk_files})
  set(MIMETRA_FIND_VTK_rendering ${same_vtk} COMPONENTS ${vtk_files} ${vtk_rendering})
endif()

if(BUILD_TESTING)
  find_package(GTest REQUIRED)
  if(MIMETRA_FILES)
    # Tests read what is written by HDF5's own library, and the other way round.
    find_package(HDF5 REQUIRED COMPONENTS C)
  endif()
  include(GoogleTest)
endif()
