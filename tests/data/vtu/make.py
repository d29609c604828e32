#!/usr/bin/env python3
"""Writes twelve points with VTK's own writers, in all the ways that its XML formats have, into a directory:

    make.py DIRECTORY

Point i is at (0.1 (i % 4), 0.1 (i // 4), 0); velocity (i, -i/2, 0) m/s, density 1000 + i/4, mass 10 + i: numbers that single
precision has, too, but for the coordinates.  Besides, data that nobody asked for.  Debian: python3-vtk9."""
import sys
import vtk

N = 12


def cloud(kind, single):
    number = vtk.vtkFloatArray if single else vtk.vtkDoubleArray
    data = kind()
    points = vtk.vtkPoints()
    points.SetDataType(vtk.VTK_FLOAT if single else vtk.VTK_DOUBLE)
    fields = {}
    for name, columns in ("velocity [m/s]", 3), ("Density [kg per m^3]", 1), ("mass", 1), ("of no use [1]", 2):
        fields[name] = number()
        fields[name].SetName(name)
        fields[name].SetNumberOfComponents(columns)
        data.GetPointData().AddArray(fields[name])
    cells = vtk.vtkCellArray()
    for i in range(N):
        points.InsertNextPoint(0.1 * (i % 4), 0.1 * (i // 4), 0)
        fields["velocity [m/s]"].InsertNextTuple3(i, -0.5 * i, 0)
        fields["Density [kg per m^3]"].InsertNextValue(1000 + 0.25 * i)
        fields["mass"].InsertNextValue(10 + i)
        fields["of no use [1]"].InsertNextTuple2(i, i)
        cells.InsertNextCell(1)
        cells.InsertCellPoint(i)
    data.SetPoints(points)
    data.SetCells(vtk.VTK_VERTEX, cells) if kind is vtk.vtkUnstructuredGrid else data.SetVerts(cells)
    return data


def write(path, mode, coding="raw", zlib=False, single=False, wide=False, big=False, kind=vtk.vtkUnstructuredGrid):
    writer = vtk.vtkXMLUnstructuredGridWriter() if kind is vtk.vtkUnstructuredGrid else vtk.vtkXMLPolyDataWriter()
    writer.SetInputData(cloud(kind, single))
    writer.SetFileName(path)
    {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary, "appended": writer.SetDataModeToAppended}[mode]()
    writer.SetEncodeAppendedData(coding == "base64")
    writer.SetCompressorTypeToZLib() if zlib else writer.SetCompressorTypeToNone()
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    writer.SetByteOrderToBigEndian() if big else writer.SetByteOrderToLittleEndian()
    writer.SetBlockSize(32)  # bytes: several blocks
    assert writer.Write() == 1


def all_ways(directory):
    for mode, coding in ("ascii", "raw"), ("binary", "raw"), ("appended", "raw"), ("appended", "base64"):
        for zlib in False, True:
            for wide in False, True:
                for single in False, True:
                    name = "-".join([mode] + ["base64"] * (coding == "base64") + ["zlib"] * zlib + ["wide"] * wide + ["single"] * single)
                    write(f"{directory}/{name}.vtu", mode, coding, zlib, single, wide)
        write(f"{directory}/{mode}-{coding}-big.vtu", mode, coding, mode == "appended", False, True, True)
        write(f"{directory}/{mode}-{coding}.vtp", mode, coding, kind=vtk.vtkPolyData)


if __name__ == "__main__":
    all_ways(sys.argv[1])
