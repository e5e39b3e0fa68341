"""What the tests of Python scripts share. Imported first: it makes scripts/ known."""
import os
import sys
import unittest
import xml.etree.ElementTree as ElementTree

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '../..'))
sys.path.insert(0, os.path.join(ROOT, 'scripts'))


class XmlResult(unittest.TextTestResult):
    """Keeps a JUnit element of each case, for scripts/count_tests.py."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.suite = ElementTree.Element('testsuite', name=os.path.basename(sys.argv[0]))

    def startTest(self, test):
        super().startTest(test)
        self.case = ElementTree.SubElement(self.suite, 'testcase', classname=type(test).__name__,
                                           name=test.id().rsplit('.', 1)[-1])

    def addFailure(self, test, error):
        super().addFailure(test, error)
        ElementTree.SubElement(self.case, 'failure', message=str(error[1]))

    addError = addFailure

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        ElementTree.SubElement(self.case, 'skipped', message=reason)


def run(*classes):
    """Runs the cases of the classes, writes the file that the command line names, and ends the program."""
    loader = unittest.defaultTestLoader
    suite = unittest.TestSuite(loader.loadTestsFromTestCase(each) for each in classes)
    result = unittest.TextTestRunner(resultclass=XmlResult).run(suite)
    if len(sys.argv) > 1:
        os.makedirs(os.path.dirname(sys.argv[1]), exist_ok=True)
        ElementTree.ElementTree(result.suite).write(sys.argv[1])
    sys.exit(0 if result.wasSuccessful() else 1)
