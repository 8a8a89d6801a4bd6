#!/bin/sh
# figures.sh FILE: a Markdown table of what GONIO_FAULT_FIGURES=FILE collected (figures.h).
sort "$1" | awk -F, '
BEGIN {
    print "| row | door | seeds | as wanted | verdict | noticed, ms | chunks again | frames redone | interruptions | commands repeated |"
    print "|---|---|---|---|---|---|---|---|---|---|"
}
{
    noticed = $6 > 0 ? sprintf("%.1f", $6) : "-"
    printf "| %s | %s | %d | %d | %s | %s | %d | %d | %d | %d |\n", $1, $2, $3, $4, $5, noticed, $7, $8, $9, $10
}'
