#!/usr/bin/env python3
"""Prints the tables of scripts/measure_motion.sh from its folder of results: motion_tables.py RESULTS SEED..."""
import json
import os
import sys

TRACKERS = ['tet', 'lsd_lbd_knn', 'lk_endpoints']
REGIMES = ['slow', 'fast', 'corridor', 'shake']
RATES = ['20', '10', '5', '3.3']
RECORDED = ['kitti_00', 'euroc_v1_01', 'euroc_v1_01-every_2nd', 'euroc_v1_01-every_4th']


PARTS = [('none (the default)', 'default'), ('depth check (`check_depth=false`)', 'depth_check'),
         ('translation and depth (`ego_motion=false`)', 'ego_motion'), ('IMU (`prior=image`)', 'imu'),
         ('motion prior (`prior=none`)', 'prior')]
PART_FLIGHTS = ['fast-20', 'fast-5', 'fast-3.3', 'corridor-5', 'corridor-3.3', 'street-10']


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


def part_cell(rows):
    if not rows:
        return 'not measured'
    ratio = mean(rows, 'inlier_ratio_2px')
    if ratio is None:
        ratio = mean(rows, 'three_view_ratio_2px')
    return '{} / {}'.format(text(ratio, '{:.2f}', 100.0), text(mean(rows, 'track_length'), '{:.1f}'))


def parts_table(folder, seeds):
    columns = [(name, ['{}-{}'.format(name, seed) for seed in seeds]) for name in PART_FLIGHTS] + [('kitti_00', ['kitti_00'])]
    print('One part off at a time: under 2 px [%] (kitti_00: triples within 2 px) / images per track\n')
    print('| part off | {} |\n|{}'.format(' | '.join(name for name, _ in columns), '---|' * (len(columns) + 1)))
    for words, part in PARTS:
        cells = []
        for _, sequences in columns:
            rows = [measures(folder, sequence, 'part-' + part) for sequence in sequences]
            cells.append(part_cell([row for row in rows if row is not None]))
        print('| {} | {} |'.format(words, ' | '.join(cells)))
    print()


def odometry_table(folder, seeds):
    priors = ['image', 'odometry', 'auto']
    print('Street by what predicts the motion (auto: the IMU): under 2 px [%] / under 1 px [%] / images per track / survival [%]\n')
    print('| | {} |\n|{}'.format(' | '.join('`prior: {}`'.format(prior) for prior in priors), '---|' * (len(priors) + 1)))
    for rate in ('10', '5', '3.3'):
        cells = []
        for prior in priors:
            rows = [measures(folder, 'street-odometry-{}-{}'.format(rate, seed), 'part-' + prior) for seed in seeds]
            cells.append(simulated_cell([row for row in rows if row is not None]))
        print('| street {} Hz | {} |'.format(rate, ' | '.join(cells)))
    print()


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
    parts_table(folder, seeds)
    odometry_table(folder, seeds)
    table('Two judges of the same triples: both line pairs within 2 px of the exact truth [%] / right by three views [%] / left out '
          'of all triples [%]', flights, of_flights(judges_cell))


if __name__ == '__main__':
    main()
