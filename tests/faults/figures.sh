#!/bin/sh
# figures.sh FILE: a Markdown table of what GONIO_FAULT_FIGURES=FILE collected (figures.h).
sort "$1" | awk -F, '
function time(ms) { return ms > 0 ? sprintf("%.1f", ms) : "-" }
BEGIN {
    print "| row | door | runs | as wanted | verdict | unplug noticed, ms | claimed again, ms | silence noticed, ms | longest call, ms | chunks again | frames redone | interruptions | commands repeated |"
    print "|---|---|---|---|---|---|---|---|---|---|---|---|---|"
}
{
    printf "| %s | %s | %d | %d | %s | %s | %s | %s | %s | %d | %d | %d | %d |\n", $1, $2, $3, $4, $5, time($6), time($7), time($8), time($9), $10, $11, $12, $13
}'
