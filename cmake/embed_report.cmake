# Compiles the files of a report's page into the binary: ours, and Chart.js where Debian's libjs-chart.js is there.
find_file(SFUMATO_CHART_JS chart.min.js PATHS /usr/share/javascript/chart.js NO_DEFAULT_PATH
          DOC "Chart.js 3, minified, for the plots of reports")
if(NOT SFUMATO_CHART_JS)
  message(STATUS "No Chart.js (libjs-chart.js): `sfumato stress --report` will say so")
endif()

function(sfumato_embed_report target)
  set(folder ${CMAKE_SOURCE_DIR}/image/report)
  set(output ${CMAKE_BINARY_DIR}/embedded_report.cpp)
  set(files "css=${folder}/report.css" "js=${folder}/report.js" "chartJs=")
  set(depends ${folder}/report.css ${folder}/report.js)
  if(SFUMATO_CHART_JS)
    set(files "css=${folder}/report.css" "js=${folder}/report.js" "chartJs=${SFUMATO_CHART_JS}")
    list(APPEND depends ${SFUMATO_CHART_JS})
  endif()
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} "-DFILES=${files}"
            -P ${CMAKE_SOURCE_DIR}/cmake/write_embedded_report.cmake
    DEPENDS ${depends} ${CMAKE_SOURCE_DIR}/cmake/write_embedded_report.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
