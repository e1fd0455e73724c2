# dlib reads images and finds faces in them; without it, landmarks come from files only.
option(MIMETRA_DLIB "Find faces in images by dlib, where it is installed" ON)
if(MIMETRA_DLIB)
  find_package(dlib QUIET)
  set(MIMETRA_FIND_dlib dlib)
endif()
