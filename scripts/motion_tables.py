#!/usr/bin/env python3
"""Prints the tables of scripts/measure_motion.sh from its folder of results: motion_tables.py RESULTS SEED..."""
import json
import os
import sys

TRACKERS = ['tet', 'lsd_lbd_knn', 'lk_endpoints']
REGIMES = ['slow', 'fast', 'corridor', 'shake']
RATES = ['20', '10', '5', '3.3']
RECORDED = ['kitti_00', 'euroc_v1_01', 'euroc_v1_01-every_2nd', 'euroc_v1_01-every_4th']


def measures(folder, sequence, tracker):
    """What evaluate_tracks says of one sequence, None: not measured."""
    path = os.path.join(folder, '{}-{}.json'.format(sequence, tracker))
    if not os.path.exists(path):
        return None
    with open(path) as file:
        return json.load(file)[0]


def text(value, style, factor=1.0):
    return '-' if value is None else style.format(factor * value)


def mean(rows, name):
    values = [row[name] for row in rows if row.get(name) is not None]
    return sum(values) / len(values) if values else None


def simulated_cell(rows):
    if not rows:
        return 'not measured'
    return '{} / {} / {} / {}'.format(text(mean(rows, 'inlier_ratio_2px'), '{:.2f}', 100.0),
                                      text(mean(rows, 'inlier_ratio_1px'), '{:.2f}', 100.0),
                                      text(mean(rows, 'track_length'), '{:.1f}'),
                                      text(mean(rows, 'survival'), '{:.1f}', 100.0))


def recorded_cell(row):
    if row is None:
        return 'not measured'
    return '{} / {} / {} / {} / {}'.format(text(row['three_view_ratio_2px'], '{:.2f}', 100.0),
                                           text(row['three_view_ratio_1px'], '{:.2f}', 100.0),
                                           text(row['three_view_left_out_ratio'], '{:.1f}', 100.0),
                                           text(row['three_view_refuted_ratio'], '{:.2f}', 100.0),
                                           text(row['track_length'], '{:.1f}'))


def judges_cell(rows):
    """Exact judge and three-view judge of the same triples."""
    if not rows:
        return 'not measured'
    return '{} / {} / {}'.format(text(mean(rows, 'both_judges_exact_ratio_2px'), '{:.2f}', 100.0),
                                 text(mean(rows, 'both_judges_three_view_ratio_2px'), '{:.2f}', 100.0),
                                 text(mean(rows, 'three_view_left_out_ratio'), '{:.1f}', 100.0))


def table(title, rows, cell):
    print('{}\n\n| | {} |\n|{}'.format(title, ' | '.join(TRACKERS), '---|' * (len(TRACKERS) + 1)))
    for name, sequences in rows:
        print('| {} | {} |'.format(name, ' | '.join(cell(sequences, tracker) for tracker in TRACKERS)))
    print()


def main():
    folder, seeds = sys.argv[1], sys.argv[2:]
    flights = [('{} {} Hz'.format(regime, rate), ['{}-{}-{}'.format(regime, rate, seed) for seed in seeds])
               for regime in REGIMES for rate in RATES]
    flights.append(('street 10 Hz', ['street-10-{}'.format(seed) for seed in seeds]))

    def of_flights(cell):
        def of(sequences, tracker):
            rows = [measures(folder, sequence, tracker) for sequence in sequences]
            return cell([row for row in rows if row is not None])
        return of

    table('Flights, seeds {}: under 2 px [%] / under 1 px [%] / images per track / survival [%]'.format(' '.join(seeds)),
          flights, of_flights(simulated_cell))
    table('Recorded: triples within 2 px [%] / within 1 px [%] / left out of all triples [%] / refuted of all triples [%] / '
          'images per track', [(name, name) for name in RECORDED],
          lambda sequence, tracker: recorded_cell(measures(folder, sequence, tracker)))
    table('Two judges of the same triples: both line pairs within 2 px of the exact truth [%] / right by three views [%] / left out '
          'of all triples [%]', flights, of_flights(judges_cell))


if __name__ == '__main__':
    main()
