# gnuplot -e "csv='tradeoff.csv'" docs/pictures/visibility_tradeoff.gp > visibility_tradeoff.svg
set terminal svg size 640,400 font "sans,12" background "white"
set datafile separator ","
set logscale x
set xlabel "milliseconds a question, mean"
set ylabel "wrong answers, %"
set xrange [0.05:400]
set yrange [-1:29]
set grid lc rgb "#dddddd"
set key top right opaque
method(name) = sprintf("< grep ^%s, %s", name, csv)
plot method("random") using 4:3 with linespoints pt 7 lc rgb "#888888" title "random segments, 10^2 to 10^6", \
     method("random") using 4:3:2 with labels offset 3,0.6 tc rgb "#666666" notitle, \
     method("double") using 4:3 with points pt 5 ps 1.2 lc rgb "#d08000" title "search, doubles only", \
     method("exact") using 4:3 with points pt 9 ps 1.4 lc rgb "#2060c0" title "search, exact"
