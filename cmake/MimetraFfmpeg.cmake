# FFmpeg's libraries read and write videos; without them, images and landmarks come from other files.
# Only the headers are needed here: the libraries are loaded when a video is opened.
option(MIMETRA_FFMPEG "Read and write videos by FFmpeg's libraries, where their headers are installed" ON)
set(MIMETRA_HAS_FFMPEG OFF)
if(MIMETRA_FFMPEG)
  find_path(FFMPEG_INCLUDE_DIR libavformat/avformat.h)
  mark_as_advanced(FFMPEG_INCLUDE_DIR)
  set(MIMETRA_HAS_FFMPEG ON)
  # Each is a package of its own; where one is missing none is used.
  foreach(library avformat avcodec swscale avutil)
    if(NOT EXISTS ${FFMPEG_INCLUDE_DIR}/lib${library})
      set(MIMETRA_HAS_FFMPEG OFF)
    endif()
  endforeach()
endif()
