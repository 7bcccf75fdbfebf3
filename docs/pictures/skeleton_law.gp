# gnuplot -e "csv='law.csv'" docs/pictures/skeleton_law.gp > docs/pictures/skeleton_law.svg
# law.csv: skeleton_scaling law 0.1 5 200
set terminal svg size 640,420 font "sans,12" background "white"
set datafile separator ","
set datafile commentschars "#"
set logscale xy
set xlabel "k sqrt(n k), for k polytopes with n edges in all"
set ylabel "nodes"
set grid lc rgb "#dddddd"
set key top left
x(k, n) = k * sqrt(n * k)
plot csv using (x($1,$2)):11 skip 1 with points pt 7 ps 0.6 lc rgb "#222222" title "all", \
     csv using (x($1,$2)):5 skip 1 with points pt 5 ps 0.6 lc rgb "#2060c0" title "VV", \
     csv using (x($1,$2)):6 skip 1 with points pt 9 ps 0.7 lc rgb "#d08000" title "VEE", \
     csv using (x($1,$2)):7 skip 1 with points pt 11 ps 0.7 lc rgb "#208050" title "EVE", \
     csv using (x($1,$2)):8 skip 1 with points pt 13 ps 0.7 lc rgb "#888888" title "FvE", \
     csv using (x($1,$2)):9 skip 1 with points pt 2 ps 0.6 lc rgb "#c02060" title "EEEE", \
     csv using (x($1,$2)):10 skip 1 with points pt 3 ps 0.6 lc rgb "#8040a0" title "FEE", \
     [*:*] 6 * x lc rgb "#bbbbbb" dt 2 title "6 k sqrt(n k)"
