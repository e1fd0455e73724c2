find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenMesh REQUIRED)
find_package(CGAL REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(HDF5 REQUIRED COMPONENTS C)

# VTK 9.1 or later: ParaView's own where it is installed, because that one serves the toolkit, the
# plugin and the tests alike; otherwise the system's.
file(GLOB paraview_vtk /usr/lib/*/cmake/paraview-*/vtk)
if(NOT VTK_DIR AND paraview_vtk)
  list(GET paraview_vtk -1 VTK_DIR)
endif()
find_package(GLEW REQUIRED)
find_package(OpenGL REQUIRED COMPONENTS EGL)
find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore CommonDataModel IOImage IOXML IOXMLParser
                                         RenderingCore RenderingFreeType RenderingOpenGL2)

if(BUILD_TESTING)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
